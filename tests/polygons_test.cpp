#include "libvox/pipeline/polygons.h"

#include "libvox/core/error.h"
#include "libvox/core/memory.h"
#include "libvox/core/parallel.h"
#include "libvox/core/progress.h"
#include "libvox/grid/active_voxels.h"
#include "libvox/grid/openvdb.h"
#include "libvox/options/voxelize.h"
#include "libvox/pipeline/choose.h"
#include "libvox/pipeline/convert.h"
#include "libvox/pipeline/refined_polygons.h"
#include "libvox/subdivide/doo_sabin.h"
#include "libvox/voxelize/scan.h"
#include "tests/conversion.h"
#include "tests/reference.h"
#include "tests/scenes.h"
#include "tests/shapes.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>

using namespace vox;
using Catch::Contains;
using openvdb::Coord;

namespace {

ConvertOptions polygonsAt(double voxelSize, int levels, Separation separation) {
  ConvertOptions options;
  options.voxelSize = voxelSize;
  options.grids = std::vector{GridKind::kMask};
  options.until = StopRule{levels};
  options.separation = separation;
  return options;
}

std::string metadataOf(const Conversion& conversion, const std::string& name) {
  return conversion.grids.at(0)->metaValue<std::string>(name);
}

int largest(const Coord& c) {
  return std::max({std::abs(c.x()), std::abs(c.y()), std::abs(c.z())});
}

/// Number of coordinates with this absolute value.
int countOf(const Coord& c, int size) {
  return (std::abs(c.x()) == size) + (std::abs(c.y()) == size) + (std::abs(c.z()) == size);
}

/// Checks that exactly those voxels of a cube around 0 are active for which isActive is true, and
/// that there are `count` of them.
template <class IsActive>
void checkVoxels(const openvdb::MaskGrid& mask, int side, std::uint64_t count,
                 IsActive&& isActive) {
  CHECK(mask.activeVoxelCount() == count);
  std::size_t wrong = 0;
  for (const Coord& c : openvdb::CoordBBox::createCube(Coord(-side), 2 * side + 1))
    wrong += mask.tree().isValueOn(c) != isActive(c);
  CHECK(wrong == 0);
}

/// Whether a path of inactive voxels, with steps to 6 or 26 neighbours, leads from outside to a
/// voxel.
bool isOpen(const openvdb::MaskGrid& mask, Separation steps, const Coord& to) {
  openvdb::CoordBBox box = mask.evalActiveVoxelBoundingBox();
  box.expand(1);
  openvdb::MaskTree reached;
  std::vector<Coord> open = {box.min()};
  reached.setValueOn(box.min());
  while (!open.empty()) {
    const Coord at = open.back();
    open.pop_back();
    if (at == to) return true;
    for (const Coord& step : openvdb::CoordBBox::createCube(Coord(-1), 3)) {
      const Coord next = at + step;
      if (steps == Separation::k6 && countOf(step, 1) != 1) continue;
      if (!box.isInside(next) || mask.tree().isValueOn(next) || reached.isValueOn(next)) continue;
      reached.setValueOn(next);
      open.push_back(next);
    }
  }
  return false;
}

/// Active voxels of one mask without an active voxel of the other within `reach` (L-inf).
std::size_t farVoxels(const openvdb::MaskGrid& from, const openvdb::MaskGrid& to, int reach) {
  std::size_t far = 0;
  for (auto voxel = from.cbeginValueOn(); voxel; ++voxel) {
    bool near = false;
    for (const Coord& step : openvdb::CoordBBox::createCube(Coord(-reach), 2 * reach + 1))
      near = near || to.tree().isValueOn(voxel.getCoord() + step);
    far += !near;
  }
  return far;
}

/// A block 12 x 8 x 6 with a slot 4 wide and 5 deep: two concave faces of 8 corners. Whole numbers.
PolygonMesh slottedBlock() {
  const std::vector<std::pair<int, int>> outline = {{-6, -4}, {6, -4},  {6, 4},  {2, 4},
                                                    {2, -1},  {-2, -1}, {-2, 4}, {-6, 4}};
  PolygonMesh mesh;
  std::vector<Index> bottom;
  std::vector<Index> top;
  for (Index i = 0; i < 8; ++i) {
    mesh.points.emplace_back(outline[i].first, outline[i].second, -3);
    mesh.points.emplace_back(outline[i].first, outline[i].second, 3);
    bottom.insert(bottom.begin(), 2 * i);
    top.push_back(2 * i + 1);
  }
  mesh.addFace(bottom);
  mesh.addFace(top);
  for (Index i = 0; i < 8; ++i) {
    const Index next = (i + 1) % 8;
    mesh.addFace(std::vector<Index>{2 * i, 2 * next, 2 * next + 1, 2 * i + 1});
  }
  return mesh;
}

bool inSlottedBlock(const Coord& c) {
  const bool inBlock = std::abs(c.x()) <= 6 && std::abs(c.y()) <= 4 && std::abs(c.z()) <= 3;
  return inBlock && !(std::abs(c.x()) < 2 && c.y() > -1);
}

}  // namespace

TEST_CASE("a cube as it is has the voxels of its six faces", "[polygons][golden]") {
  const auto convertCube = [](double halfSide, Separation separation) {
    return convert(test::oneObject(test::cube()), polygonsAt(1 / halfSide, 0, separation));
  };
  // The faces pass through voxel centres.
  for (const Separation separation : {Separation::k6, Separation::k26}) {
    const Conversion conversion = convertCube(4, separation);
    checkVoxels(test::maskOf(conversion), 6, 9 * 9 * 9 - 7 * 7 * 7,
                [](const Coord& c) { return largest(c) == 4; });
    CHECK(conversion.report.objects[0].polygons.triangles == 12);
    CHECK(conversion.report.objects[0].levels == 0);
  }
  // The edges are nearer than 1/2 to voxels, but do not reach their centres.
  checkVoxels(test::maskOf(convertCube(3.75, Separation::k6)), 6, 6 * 7 * 7,
              [](const Coord& c) { return largest(c) == 4 && countOf(c, 4) == 1; });
  checkVoxels(test::maskOf(convertCube(3.75, Separation::k26)), 6, 9 * 9 * 9 - 7 * 7 * 7,
              [](const Coord& c) { return largest(c) == 4; });
  // The faces are between voxels: those on both sides are active.
  checkVoxels(
      test::maskOf(convertCube(3.5, Separation::k6)), 6, 6 * 7 * 7 + 7 * 7 * 7 - 5 * 5 * 5,
      [](const Coord& c) { return largest(c) == 3 || (largest(c) == 4 && countOf(c, 4) == 1); });
  checkVoxels(test::maskOf(convertCube(3.5, Separation::k26)), 6, 9 * 9 * 9 - 5 * 5 * 5,
              [](const Coord& c) { return largest(c) == 3 || largest(c) == 4; });
}

TEST_CASE("concave faces are filled and no farther", "[polygons][golden]") {
  const Separation separation = GENERATE(Separation::k6, Separation::k26);
  const Conversion conversion =
      convert(test::oneObject(slottedBlock()), polygonsAt(1, 0, separation));
  // The active voxels are the lattice points on the surface of the solid: those with a neighbour
  // outside.
  std::uint64_t count = 0;
  const auto isActive = [&](const Coord& c) {
    bool surrounded = true;
    for (const Coord& step : openvdb::CoordBBox::createCube(Coord(-1), 3))
      surrounded = surrounded && inSlottedBlock(c + step);
    return inSlottedBlock(c) && !surrounded;
  };
  for (const Coord& c : openvdb::CoordBBox::createCube(Coord(-8), 17)) count += isActive(c);
  checkVoxels(test::maskOf(conversion), 8, count, isActive);
  CHECK(conversion.report.objects[0].polygons.triangles == 2 * 6 + 8 * 2);
  CHECK(conversion.report.objects[0].polygons.fanned == 0);
}

TEST_CASE("a prism of any number of sides has the voxels of its faces as fans",
          "[polygons][property]") {
  const int sides = GENERATE(3, 5, 8, 30);
  const Separation separation = GENERATE(Separation::k6, Separation::k26);
  CAPTURE(sides);
  const PolygonMesh mesh = test::prism(sides);
  const double voxelSize = 0.07;
  const Conversion conversion =
      convert(test::oneObject(mesh), polygonsAt(voxelSize, 0, separation));
  // The faces are convex, and flat also after their corners are snapped, so any fan is right.
  std::vector<Vec3d> points;
  for (const Vec3d& p : mesh.points) points.push_back(p / voxelSize);
  openvdb::MaskTree expected;
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    const auto face = mesh.face(f);
    for (std::size_t i = 2; i < face.size(); ++i) {
      const std::array<Vec3d, 3> corners = {points[face[0]], points[face[i - 1]], points[face[i]]};
      scanTriangle(corners, separation, [&](const VoxelBlock& block) {
        forEachVoxel(block, [&](int x, int y, int z) { expected.setValueOn(Coord(x, y, z)); });
      });
    }
  }
  CHECK(test::maskOf(conversion).activeVoxelCount() == expected.activeVoxelCount());
  CHECK(test::maskOf(conversion).tree().hasSameTopology(expected));
}

TEST_CASE("polygons of any level separate inside from outside, by either separation",
          "[polygons][property]") {
  const int levels = GENERATE(0, 1, 3);
  bool diagonalStepsLeak = false;
  for (const PolygonMesh& mesh : {test::cube(), test::dodecahedron(), test::prism(7)}) {
    const Scene scene = test::oneObject(mesh);
    const Coord centre =
        Coord::round(openvdb::Vec3d((test::centroid(mesh.points) / 0.09).eval().data()));
    const Conversion six = convert(scene, polygonsAt(0.09, levels, Separation::k6));
    const Conversion all = convert(scene, polygonsAt(0.09, levels, Separation::k26));
    REQUIRE_FALSE(test::maskOf(all).tree().isValueOn(centre));
    CHECK_FALSE(isOpen(test::maskOf(six), Separation::k6, centre));
    CHECK_FALSE(isOpen(test::maskOf(all), Separation::k26, centre));
    diagonalStepsLeak = diagonalStepsLeak || isOpen(test::maskOf(six), Separation::k26, centre);
    CHECK(metadataOf(six, "vox_guarantee") == "6-separating");
    CHECK(metadataOf(all, "vox_guarantee") == "26-separating");

    PolygonMesh refined = subdivide(baseLevel(mesh), levels).mesh;
    for (Vec3d& p : refined.points) p /= 0.09;
    for (const Conversion* conversion : {&six, &all}) {
      const test::Sides sides = test::sidesOf(refined, test::maskOf(*conversion));
      CHECK(sides.leaks == 0);
      CHECK(sides.inside > 0);
    }
  }
  CHECK(diagonalStepsLeak);  // the check sees leaks
}

TEST_CASE("thread count never changes the voxels of polygons", "[polygons][parallel]") {
  const Separation separation = GENERATE(Separation::k6, Separation::k26);
  ConvertOptions options = polygonsAt(0.02, 3, separation);
  options.run.threads = 1;
  const Scene scene = test::oneObject(test::torusGrid(12, 7));
  const Conversion alone = convert(scene, options);
  for (const int threads : {2, 8}) {
    options.run.threads = threads;
    const Conversion together = convert(scene, options);
    CHECK(test::bytesOf(together) == test::bytesOf(alone));
    CHECK(together.report.objects[0].polygons.triangles ==
          alone.report.objects[0].polygons.triangles);
  }
}

TEST_CASE("vertex conversion of a deep refinement stays within a voxel of its polygons",
          "[polygons][property]") {
  for (const PolygonMesh& mesh : {test::cube(), test::dodecahedron(), test::pyramid(5)}) {
    ConvertOptions options = polygonsAt(0.06, 0, Separation::k6);
    options.until = StopRule();
    const Conversion vertices = convert(test::oneObject(mesh), options);
    const int levels = vertices.report.objects[0].levels;
    for (const Separation separation : {Separation::k6, Separation::k26}) {
      const Conversion polygons =
          convert(test::oneObject(mesh), polygonsAt(0.06, levels, separation));
      CHECK(farVoxels(test::maskOf(vertices), test::maskOf(polygons), 1) == 0);
      CHECK(farVoxels(test::maskOf(polygons), test::maskOf(vertices), 1) == 0);
    }
  }
}

TEST_CASE("a stop rule of the options wins over objects, theirs over the scene", "[polygons]") {
  Scene scene = test::oneObject(test::cube());
  scene.objects.push_back({"second", test::cube()});
  scene.until = StopRule{1};
  scene.objects[1].until = StopRule{2};
  ConvertOptions options;
  options.dim = 16;
  const auto trianglesOf = [&](std::size_t object) {
    return convert(scene, options).report.objects[object].polygons.triangles;
  };
  CHECK(trianglesOf(0) == 6 * 2 + 12 * 2 + 8);
  CHECK(trianglesOf(1) == 18 * 2 + 8 + 48 * 2 + 24 * 2);
  options.until = StopRule{0};
  CHECK(trianglesOf(0) == 12);
  CHECK(trianglesOf(1) == 12);
  CHECK_THAT(metadataOf(convert(scene, options), "vox_options"), Contains("until=levels=0"));
  options.until = StopRule();
  const ConvertReport report = convert(scene, options).report;
  CHECK(report.objects[0].polygons.triangles == 0);
  CHECK(report.objects[0].vertices > 0);
}

TEST_CASE("one object may stay polygons while another is smoothed", "[polygons]") {
  Scene scene = test::oneObject(test::cube());
  scene.objects.push_back({"smooth", test::cube()});
  scene.objects[0].until = StopRule{0};
  for (Vec3d& p : scene.objects[1].mesh.points) p += Vec3d(4, 0, 0);
  ConvertOptions options = polygonsAt(0.25, 0, Separation::k6);
  options.until.reset();
  const Conversion conversion = convert(scene, options);
  CHECK(test::maskOf(conversion).tree().isValueOn(Coord(4, 4, 4)));  // a corner of the first
  CHECK_FALSE(
      test::maskOf(conversion).tree().isValueOn(Coord(20, 4, 4)));  // is rounded off the second
  CHECK(test::maskOf(conversion).tree().isValueOn(Coord(20, 0, 0)));
  options.separation = Separation::k26;
  options.voxelize = Voxelize::kVertex;
  CHECK_THROWS_WITH(convert(scene, options), Contains("object") && Contains("needs --until voxel"));
}

TEST_CASE("an open mesh at level 0 does not shrink, and there is no warning", "[polygons]") {
  ConvertOptions options = polygonsAt(0.1, 0, Separation::k6);
  options.smoothing.boundary = BoundaryRule::kFree;
  CHECK(convert(test::oneObject(test::sheet(3, 3)), options).report.warnings.empty());
  options.until = StopRule{1};
  CHECK(convert(test::oneObject(test::sheet(3, 3)), options).report.warnings.size() == 1);
}

TEST_CASE("polygons that fold become fans, with a warning", "[polygons]") {
  // Its sides cross, and its halves turn opposite ways.
  const PolygonMesh bow =
      test::meshOf({{0, 0, 0}, {1, 1, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2, 3}});
  const Conversion conversion = convert(test::oneObject(bow), polygonsAt(0.05, 0, Separation::k6));
  CHECK(conversion.report.objects[0].polygons.fanned == 1);
  CHECK(conversion.report.objects[0].polygons.triangles == 2);
  REQUIRE(conversion.report.warnings.size() == 1);
  CHECK_THAT(conversion.report.warnings[0], Contains("object: 1 polygon is folded"));
}

TEST_CASE("impossible options for polygons are refused", "[polygons][error]") {
  const Scene scene = test::oneObject(test::cube());
  ConvertOptions options = polygonsAt(0.1, 0, Separation::k26);
  for (const int levels : {-1, kMostLevels + 1}) {
    options.until = StopRule{levels};
    CHECK_THROWS_AS(convert(scene, options), UsageError);
  }
  options.until.reset();
  options.voxelize = Voxelize::kVertex;
  CHECK_THROWS_WITH(convert(scene, options), Contains("cannot make 26-separating"));
  options.voxelize.reset();
  for (const StopRule& rule :
       {StopRule{{}, 0.0}, StopRule{{}, {}, 181.0}, StopRule{{}, {}, {}, -1.0}}) {
    options.until = rule;
    CHECK_THROWS_AS(convert(scene, options), UsageError);
  }
  options.until = StopRule{kMostLevels};
  options.run.maxMemory = std::uint64_t{100} << 20U;
  CHECK_THROWS_WITH(convert(scene, options), Contains("vertices") && Contains("use fewer levels"));
}

TEST_CASE("a grid of polygons keeps to the memory that the mesh leaves", "[polygons][error]") {
  const SubdivisionLevel base = baseLevel(test::cube());
  ActiveVoxels grid;
  PolygonReport report;
  Progress unwatched;
  CHECK_THROWS_AS(markPolygons(base, StopRule{0}, {}, Separation::k6, MemoryBudget(20000),
                               unwatched, grid, report),
                  LimitError);
}

TEST_CASE("voxels of refined polygons are the same for every cut and any threads",
          "[polygons][parallel]") {
  const std::vector<StopRule> rules = {StopRule{4}, StopRule{{}, 3.0}, StopRule{{}, {}, 4.0},
                                       StopRule{{}, {}, {}, 0.1}};
  for (const PolygonMesh& mesh : {test::prism(12), test::torusGrid(4, 32), test::sheet(5, 4)})
    for (const StopRule& rule : rules) {
      CAPTURE(stopRuleName(rule));
      ConvertOptions options = polygonsAt(0.01, 0, Separation::k6);
      options.until = rule;
      options.grids = std::vector{GridKind::kMask, GridKind::kNormal};
      options.surface = {Localize::kBefore, 1};
      options.run.threads = 1;
      const std::string alone = test::bytesOf(convert(test::oneObject(mesh), options));
      options.surface = {};
      options.run.threads = 8;
      CHECK(test::bytesOf(convert(test::oneObject(mesh), options)) == alone);
      if (rule != StopRule{4}) continue;
      // The plain algorithm differs in the last bits of its points.
      options.surface.localize = Localize::kOff;
      const Conversion whole = convert(test::oneObject(mesh), options);
      options.surface.localize = Localize::kDuring;
      const Conversion local = convert(test::oneObject(mesh), options);
      CHECK(whole.report.objects[0].polygons.triangles ==
            local.report.objects[0].polygons.triangles);
      CHECK(farVoxels(test::maskOf(whole), test::maskOf(local), 1) == 0);
      CHECK(farVoxels(test::maskOf(local), test::maskOf(whole), 1) == 0);
    }
}

TEST_CASE("polygons of every rule separate inside from outside, by either separation",
          "[polygons][property]") {
  for (const StopRule& rule :
       {StopRule{{}, 3.0}, StopRule{{}, {}, 10.0}, StopRule{{}, {}, {}, 0.1}, StopRule{2, 1.0}})
    for (const PolygonMesh& mesh : {test::cube(), test::dodecahedron(), test::prism(7)})
      for (const Separation separation : {Separation::k6, Separation::k26}) {
        CAPTURE(stopRuleName(rule));
        ConvertOptions options = polygonsAt(0.05, 0, separation);
        options.until = rule;
        const Conversion conversion = convert(test::oneObject(mesh), options);
        const Coord centre =
            Coord::round(openvdb::Vec3d((test::centroid(mesh.points) / 0.05).eval().data()));
        REQUIRE_FALSE(test::maskOf(conversion).tree().isValueOn(centre));
        CHECK_FALSE(isOpen(test::maskOf(conversion), separation, centre));
      }
}

TEST_CASE("vertices lie in the 26-separating voxels of the polygons that fit into voxels",
          "[polygons][property]") {
  for (const PolygonMesh& mesh : {test::cube(), test::dodecahedron(), test::pyramid(9)}) {
    ConvertOptions options = polygonsAt(0.03, 0, Separation::k6);
    options.until = StopRule();
    const Conversion vertices = convert(test::oneObject(mesh), options);
    options.separation = Separation::k26;
    options.voxelize = Voxelize::kPolygon;
    const Conversion polygons = convert(test::oneObject(mesh), options);
    CHECK(polygons.report.objects[0].byPolygons);
    // The two meshes have different vertices; both are within 0.1 of the surface.
    CHECK(farVoxels(test::maskOf(vertices), test::maskOf(polygons), 1) == 0);
    CHECK(farVoxels(test::maskOf(polygons), test::maskOf(vertices), 1) == 0);
    options.voxelize.reset();
    const Conversion automatic = convert(test::oneObject(mesh), options);
    CHECK(automatic.report.objects[0].until == StopRule{{}, {}, {}, kAutomaticFlatness});
    CHECK(farVoxels(test::maskOf(vertices), test::maskOf(automatic), 1) == 0);
    CHECK(farVoxels(test::maskOf(automatic), test::maskOf(vertices), 1) == 0);
  }
}

TEST_CASE("the triangle soup of a surface is closed and the same for any threads",
          "[polygons][parallel]") {
  SubdivisionLevel base = baseLevel(test::dodecahedron());
  for (Vec3d& p : base.mesh.points) p *= 50;
  Progress unwatched;
  const StopRule flat = {.flatness = 0.1};
  const auto make = [&] { return triangleSoup(base, flat, {}, unwatched); };
  const TriangleSoup soup = onThreads(1, make);
  const TriangleSoup again = onThreads(8, make);
  CHECK(soup.points == again.points);
  CHECK(soup.triangles == again.triangles);
  // The triangles are closed: their area vectors add up to 0.
  Vec3d sum = Vec3d::Zero();
  double area = 0;
  for (const auto& [a, b, c] : soup.triangles) {
    const Vec3d twice = (soup.points[b] - soup.points[a]).cross(soup.points[c] - soup.points[a]);
    sum += twice;
    area += twice.norm();
  }
  CHECK(area > 1000);
  CHECK(sum.norm() < 1e-9 * area);
}
