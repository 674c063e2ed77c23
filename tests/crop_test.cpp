// Conversions of a part of the grid: --bounds and --clip.

#include "libvox/grid/crop.h"

#include "libvox/core/error.h"
#include "libvox/core/numbered.h"
#include "libvox/grid/openvdb.h"
#include "libvox/grid/region.h"
#include "libvox/pipeline/convert.h"
#include "libvox/pipeline/crop_polygons.h"
#include "libvox/prepare/enclosure.h"
#include "tests/conversion.h"
#include "tests/scenes.h"
#include "tests/shapes.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <random>
#include <string>
#include <utility>
#include <vector>

using namespace vox;
using openvdb::Coord;
using openvdb::CoordBBox;

namespace {

const std::vector<GridKind> kAllKinds = {GridKind::kMask, GridKind::kDensity, GridKind::kSurface,
                                         GridKind::kNormal, GridKind::kColor};

using Bounds = std::array<double, 6>;

bool holds(const Bounds& box, const openvdb::Vec3d& p) {
  for (int axis = 0; axis < 3; ++axis) {
    const auto slot = static_cast<std::size_t>(axis);
    if (p[axis] < box[slot] || p[axis] > box[slot + 3]) return false;
  }
  return true;
}

/// Number of voxels at which `part` is not `whole` within the box and the background outside it.
template <class GridT>
std::uint64_t differences(const GridT& whole, const GridT& part, const Bounds& box) {
  CHECK(whole.transform() == part.transform());
  CHECK(whole.background() == part.background());
  CoordBBox all = whole.evalActiveVoxelBoundingBox();
  all.expand(part.evalActiveVoxelBoundingBox());
  all.expand(10);
  const auto ofWhole = whole.getConstAccessor();
  const auto ofPart = part.getConstAccessor();
  std::uint64_t count = 0;
  for (auto at = all.begin(); at != all.end(); ++at) {
    const bool inside = holds(box, whole.indexToWorld(*at));
    const bool active = inside && ofWhole.isValueOn(*at);
    const auto value = inside ? ofWhole.getValue(*at) : whole.background();
    if (active != ofPart.isValueOn(*at) || value != ofPart.getValue(*at)) ++count;
  }
  return count;
}

std::uint64_t differences(const openvdb::GridBase& whole, const openvdb::GridBase& part,
                          const Bounds& box) {
  const auto as = [&](auto kind) -> std::uint64_t {
    using GridT = decltype(kind);
    return differences(dynamic_cast<const GridT&>(whole), dynamic_cast<const GridT&>(part), box);
  };
  if (whole.isType<openvdb::MaskGrid>()) return as(openvdb::MaskGrid());
  if (whole.isType<openvdb::FloatGrid>()) return as(openvdb::FloatGrid());
  return as(openvdb::Vec3SGrid());
}

struct Case {
  std::string name;
  Scene scene;
};

std::vector<Case> cases() {
  std::vector<Case> all;
  all.push_back({"torus", test::oneObject(test::torusGrid(12, 8))});
  all.push_back({"sheet", test::oneObject(test::sheet(6, 5))});
  all.push_back({"bodies that overlap",
                 test::sceneOf({test::cube(), test::moved(test::cube(), {0.5, 0.4, 0.3})})});
  all.push_back({"body and sheet", test::sceneOf({test::dodecahedron(), test::tube(8, 3)})});
  for (Case& one : all) {
    PolygonMesh& mesh = one.scene.objects[0].mesh;
    for (const Vec3d& point : mesh.points)
      mesh.pointColors.emplace_back(Vec3d(point.cwiseAbs().array() / 8).cast<float>());
  }
  return all;
}

ConvertOptions optionsOf(Fill fill, Edge edge) {
  ConvertOptions options;
  options.dim = 24;
  options.grids = kAllKinds;
  options.volume.fill = fill;
  options.volume.edge = edge;
  return options;
}

/// Boxes around the middle of a scene, by parts of its own box.
std::vector<Bounds> boxesOf(const Scene& scene) {
  Box box;
  for (const SceneObject& object : scene.objects) box.add(usedBox(object.mesh));
  const auto part = [&](const Vec3d& low, const Vec3d& high) {
    const Vec3d size = box.high - box.low;
    const Vec3d a = box.low + low.cwiseProduct(size);
    const Vec3d b = box.low + high.cwiseProduct(size);
    return Bounds{a.x(), a.y(), a.z(), b.x(), b.y(), b.z()};
  };
  return {part({-1, -1, -1}, {2, 2, 2}),          part({-1, -1, -1}, {0.43, 2, 2}),
          part({0.2, 0.35, 0.1}, {0.71, 0.9, 2}), part({0.4, 0.4, 0.4}, {0.6, 0.6, 0.6}),
          part({1.5, 1.5, 1.5}, {2.5, 2.5, 2.5}), part({0.5, -1, -1}, {0.56, 2, 2})};
}

}  // namespace

TEST_CASE("a crop is the whole conversion within the box, and nothing else", "[crop][property]") {
  const auto fill = GENERATE(Fill::kSurface, Fill::kSolid);
  const auto edge = GENERATE(Edge::kHard, Edge::kSoft);
  for (const Case& one : cases()) {
    const ConvertOptions options = optionsOf(fill, edge);
    const Conversion whole = convert(one.scene, options);
    for (const Bounds& box : boxesOf(one.scene)) {
      ConvertOptions cropped = options;
      cropped.bounds = box;
      const Conversion part = convert(one.scene, cropped);
      for (std::size_t i = 0; i < kAllKinds.size(); ++i) {
        CAPTURE(one.name, box, fill == Fill::kSolid, edge == Edge::kSoft,
                whole.grids[i]->getName());
        CHECK(differences(*whole.grids[i], *part.grids[i], box) == 0);
      }
    }
  }
}

TEST_CASE("a crop without volumes or by polygons is the whole conversion within the box",
          "[crop][property]") {
  const auto until =
      GENERATE(StopRule{}, StopRule{.levels = 0}, StopRule{.levels = 2}, StopRule{.flatness = 0.3});
  const auto edge = GENERATE(Edge::kHard, Edge::kSoft);
  for (const Case& one : cases()) {
    ConvertOptions options = optionsOf(Fill::kSurface, edge);
    options.grids = {GridKind::kMask, GridKind::kNormal, GridKind::kColor, GridKind::kDensity};
    options.until = until;
    options.surface.submeshFaces = 4;
    const Conversion whole = convert(one.scene, options);
    for (const Bounds& box : boxesOf(one.scene)) {
      ConvertOptions cropped = options;
      cropped.bounds = box;
      const Conversion part = convert(one.scene, cropped);
      for (std::size_t i = 0; i < whole.grids.size(); ++i) {
        CAPTURE(one.name, box, edge == Edge::kSoft, whole.grids[i]->getName());
        CHECK(differences(*whole.grids[i], *part.grids[i], box) == 0);
      }
    }
  }
}

TEST_CASE("a crop that holds everything has the bytes of the whole but for its options", "[crop]") {
  const Scene scene = test::oneObject(test::torusGrid(12, 8));
  ConvertOptions options = optionsOf(Fill::kSolid, Edge::kHard);
  const Conversion whole = convert(scene, options);
  options.bounds = Bounds{-99, -99, -99, 99, 99, 99};
  const Conversion part = convert(scene, options);
  for (const Conversion* one : {&whole, &part})
    for (const auto& grid : one->grids) grid->removeMeta("vox_options");
  CHECK(test::bytesOf(whole) == test::bytesOf(part));
  CHECK(whole.report.activeVoxels == part.report.activeVoxels);
}

TEST_CASE("voxels whose centres lie on the box belong to the crop", "[crop]") {
  const Scene scene = test::oneObject(test::cube());
  ConvertOptions options;
  options.voxelSize = 0.1;
  options.until = StopRule{.levels = 0};
  options.grids = {GridKind::kMask};
  options.bounds = Bounds{-0.3, -0.7, -2, 0.3, 0.7, 2};  // no multiple of 0.1 is exact
  const CoordBBox box = convert(scene, options).grids[0]->evalActiveVoxelBoundingBox();
  CHECK(box == CoordBBox({-3, -7, -10}, {3, 7, 10}));
}

TEST_CASE("the box is that of the input, whichever axis points up", "[crop]") {
  const Scene scene = test::oneObject(test::torusGrid(12, 8));
  ConvertOptions options;
  options.voxelSize = 0.1;
  options.grids = {GridKind::kMask};
  options.bounds = Bounds{-9, 0.35, -9, 9, 9, 9};
  const auto plain = convert(scene, options).grids[0];
  options.volume.up = UpAxis::kY;
  const auto turnedGrid = convert(scene, options).grids[0];
  CHECK(plain->evalActiveVoxelBoundingBox().min().y() == 4);
  CHECK(turnedGrid->evalActiveVoxelBoundingBox().min().z() == 4);  // y became z
  CHECK(turnedGrid->activeVoxelCount() == plain->activeVoxelCount());
}

TEST_CASE("bounds and clip both apply", "[crop]") {
  const Scene scene = test::oneObject(test::cube());
  ConvertOptions options;
  options.voxelSize = 0.1;
  options.until = StopRule{.levels = 0};
  options.grids = {GridKind::kDensity};
  options.volume.fill = Fill::kSolid;
  options.bounds = Bounds{-9, -9, 0, 9, 9, 9};
  options.clip = std::array{-2, -3, -4, 5, 6, 7};
  const Conversion part = convert(scene, options);
  CHECK(part.grids[0]->evalActiveVoxelBoundingBox() == CoordBBox({-2, -3, 0}, {5, 6, 7}));
  CHECK(part.grids[0]->activeVoxelCount() == 8U * 10U * 8U);  // solid to the cut
}

TEST_CASE("a box without a surface gives empty grids and a warning", "[crop]") {
  const Scene scene = test::oneObject(test::cube());
  ConvertOptions options = optionsOf(Fill::kSurface, Edge::kHard);
  options.bounds = Bounds{50, 50, 50, 60, 60, 60};
  const Conversion part = convert(scene, options);
  for (const auto& grid : part.grids) CHECK(grid->activeVoxelCount() == 0);
  REQUIRE_FALSE(part.report.warnings.empty());
  CHECK_THAT(part.report.warnings.back(), Catch::Contains("--bounds"));
}

TEST_CASE("boxes that are none are refused", "[crop][error]") {
  const Scene scene = test::oneObject(test::cube());
  ConvertOptions options;
  const double nan = std::nan("");
  for (const Bounds& box :
       {Bounds{0, 0, 0, -1, 1, 1}, Bounds{0, 0, 0, 1, nan, 1}, Bounds{0, 0, 0, 1, 1, INFINITY}}) {
    options.bounds = box;
    CHECK_THROWS_AS(convert(scene, options), UsageError);
  }
  options.voxelSize = 0.1;
  options.bounds = Bounds{0.01, 0, 0, 0.02, 1, 1};
  CHECK_THROWS_WITH(convert(scene, options), Catch::Contains("no centre of a voxel"));
}

TEST_CASE("a crop does not depend on threads", "[crop][parallel]") {
  const Scene scene = test::sceneOf({test::torusGrid(12, 8), test::cube()});
  ConvertOptions options = optionsOf(Fill::kSolid, Edge::kSoft);
  options.bounds = Bounds{-0.5, -9, -9, 0.8, 9, 9};
  options.run.threads = 1;
  const std::string one = test::bytesOf(convert(scene, options));
  options.run.threads = 2;
  CHECK(test::bytesOf(convert(scene, options)) == one);
}

TEST_CASE("the voxels of a leaf within a region are those that it contains", "[crop][property]") {
  std::mt19937 random(5);
  std::uniform_int_distribution<int> at(-6, 14);
  for (int i = 0; i < 300; ++i) {
    const auto corner = [&] { return Coord(at(random), at(random), at(random)); };
    const Coord a = corner();
    const Coord b = corner();
    const Region region(CoordBBox(Coord::minComponent(a, b), Coord::maxComponent(a, b)));
    LeafWords all;
    for (auto& word : all) word = std::uint64_t{random()} << 32U | random();
    const LeafWords kept = region.within(all, {0, 0, 0});
    for (int v = 0; v < 512; ++v) {
      const auto isIn = [&](const LeafWords& words) {
        return (words[static_cast<std::size_t>(v >> 6)] >> static_cast<unsigned>(v & 63) & 1U) != 0;
      };
      REQUIRE(isIn(kept) == (isIn(all) && region.contains({v >> 6, v >> 3 & 7, v & 7})));
    }
  }
}

TEST_CASE("a cropped tree keeps its tiles within the box, and no node outside",
          "[crop][property]") {
  openvdb::initialize();
  std::mt19937 random(8);
  std::uniform_int_distribution<int> at(-150, 200);
  for (int i = 0; i < 6; ++i) {
    const auto corner = [&] { return Coord(at(random), at(random), at(random)); };
    openvdb::FloatTree tree(3.0F);
    tree.fill(CoordBBox({-100, -64, -30}, {140, 60, 77}), -3.0F, false);
    tree.fill(CoordBBox({-128, 0, 0}, {127, 127, 127}), 2.0F, true);
    const Coord a = corner();
    const Coord b = corner();
    const CoordBBox box(Coord::minComponent(a, b), Coord::maxComponent(a, b));
    openvdb::FloatTree cropped(tree);
    crop(cropped, Region(box));
    for (int k = 0; k < 20000; ++k) {
      const Coord voxel = corner();
      REQUIRE(cropped.getValue(voxel) == (box.isInside(voxel) ? tree.getValue(voxel) : 3.0F));
      REQUIRE(cropped.isValueOn(voxel) == (box.isInside(voxel) && tree.isValueOn(voxel)));
    }
    for (auto leaf = cropped.cbeginLeaf(); leaf; ++leaf)
      REQUIRE(box.hasOverlap(leaf->getNodeBoundingBox()));
  }
}

TEST_CASE("the volume of a mesh is the sum of those in the boxes that cut it", "[crop][estimate]") {
  const PolygonMesh mesh = test::torusGrid(16, 9);
  const double all = signedVolume(mesh, numbered(mesh.faceCount())).volume;
  double sum = 0;
  for (int octant = 0; octant < 8; ++octant) {
    Box box{Vec3d::Constant(-9), Vec3d::Constant(9)};
    for (int axis = 0; axis < 3; ++axis)
      ((octant >> axis & 1) != 0 ? box.low : box.high)[axis] = 0.13 * (axis + 1);
    sum += volumeWithin(box, mesh);
  }
  CHECK(sum == Approx(all));
  CHECK(volumeWithin({Vec3d::Constant(-0.5), Vec3d::Constant(0.5)}, test::cube()) == Approx(1));
  CHECK(volumeWithin({{0, 0, 0.5}, {3, 3, 3}}, test::cube()) == Approx(0.5));
}

TEST_CASE("the estimate of a crop is that of its part of the surface", "[crop][estimate]") {
  const Scene scene = test::oneObject(test::torusGrid(24, 16));
  ConvertOptions options;
  options.dim = 200;
  options.grids = {GridKind::kMask, GridKind::kDensity};
  options.volume.fill = GENERATE(Fill::kSurface, Fill::kSolid);
  options.bounds = Bounds{0.3, -9, -9, 9, 0.4, 9};
  std::vector<std::string> warnings;
  const Estimate expected = estimate(scene, options, warnings);
  const Conversion made = convert(scene, options);
  CHECK(expected.voxels == Approx(static_cast<double>(made.report.activeVoxels)).epsilon(0.3));
  for (std::size_t i = 0; i < made.grids.size(); ++i) {
    CHECK(expected.grids[i].voxels ==
          Approx(static_cast<double>(made.grids[i]->activeVoxelCount())).epsilon(0.3));
    CHECK(expected.grids[i].bytes ==
          Approx(static_cast<double>(made.grids[i]->memUsage())).epsilon(0.5));
  }
}
