// The grid `part`, and densities split into parts.

#include "libvox/core/error.h"
#include "libvox/core/progress.h"
#include "libvox/grid/openvdb.h"
#include "libvox/pipeline/convert.h"
#include "libvox/pipeline/parts.h"
#include "libvox/pipeline/refine.h"
#include "libvox/volume/split_density.h"
#include "libvox/volume/spread_labels.h"
#include "tests/conversion.h"
#include "tests/scenes.h"
#include "tests/shapes.h"

#include <catch2/catch.hpp>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <set>
#include <string>
#include <utility>
#include <vector>

using namespace vox;
using Catch::Contains;
using openvdb::Coord;

namespace {

ConvertOptions partsAt(double voxelSize, int levels) {
  ConvertOptions options;
  options.voxelSize = voxelSize;
  options.grids = std::vector{GridKind::kPart, GridKind::kMask};
  options.until = StopRule{.levels = levels};
  return options;
}

const openvdb::Int32Grid& partOf(const Conversion& conversion, std::size_t i = 0) {
  return dynamic_cast<const openvdb::Int32Grid&>(*conversion.grids.at(i));
}

Vec3d centreOf(const openvdb::GridBase& grid, const Coord& voxel) {
  return Vec3d(grid.indexToWorld(voxel).asPointer());
}

/// Distance from the surface of the cube [-1, 1]^3 around a centre.
double distanceFromCube(const Vec3d& point, const Vec3d& centre) {
  const Vec3d away = (point - centre).cwiseAbs() - Vec3d::Ones();
  const double inside = away.maxCoeff();
  return inside <= 0 ? -inside : away.cwiseMax(0).norm();
}

/// Number of voxels that are active in one of two grids only.
template <class A, class B>
std::uint64_t differentVoxels(const A& a, const B& b) {
  openvdb::MaskTree onlyA(a.tree(), false, true, openvdb::TopologyCopy());
  openvdb::MaskTree onlyB(b.tree(), false, true, openvdb::TopologyCopy());
  const openvdb::MaskTree copy(onlyA);
  onlyA.topologyDifference(onlyB);
  onlyB.topologyDifference(copy);
  return onlyA.activeVoxelCount() + onlyB.activeVoxelCount();
}

std::uint64_t differentValues(const openvdb::Int32Grid& a, const openvdb::Int32Grid& b) {
  std::uint64_t count = differentVoxels(a, b);
  const auto values = b.getConstAccessor();
  for (auto value = a.cbeginValueOn(); value; ++value) {
    openvdb::CoordBBox box;
    value.getBoundingBox(box);
    for (auto at = box.begin(); at != box.end(); ++at) count += values.getValue(*at) != *value;
  }
  return count;
}

/// A cube with a group of its own for each face, named by its normal.
PolygonMesh cubeOfGroups() {
  PolygonMesh mesh = test::cube();
  FaceSets& groups = mesh.attributes.groups;
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    const Vec3d middle = test::faceCentroid(mesh, f);
    Vec3d::Index axis = 0;
    middle.cwiseAbs().maxCoeff(&axis);
    groups.names.push_back(std::string(middle[axis] > 0 ? "+" : "-") + "xyz"[axis]);
    groups.ofFaces.push_back(f);
  }
  return mesh;
}

/// A unit sphere, nearly: a cube, refined, and pushed onto it.
PolygonMesh ballOfQuads() {
  PolygonMesh mesh = refine(test::oneObject(test::cube()), 4, {}, {}).mesh;
  for (Vec3d& point : mesh.points) point.normalize();
  return mesh;
}

/// A grid of n x n quads in the plane z = 0, a group for each.
PolygonMesh tiles(int n) {
  PolygonMesh mesh;
  for (int y = 0; y <= n; ++y)
    for (int x = 0; x <= n; ++x) mesh.points.emplace_back(x, y, 0);
  for (int y = 0; y < n; ++y)
    for (int x = 0; x < n; ++x) {
      const auto at = static_cast<Index>(y * (n + 1) + x);
      const auto row = static_cast<Index>(n + 1);
      mesh.addFace(std::array{at, at + 1, at + 1 + row, at + row});
      mesh.attributes.groups.names.push_back("tile " + std::to_string(mesh.faceCount()));
      mesh.attributes.groups.ofFaces.push_back(mesh.faceCount() - 1);
    }
  return mesh;
}

}  // namespace

TEST_CASE("where objects meet, each voxel has the part of the nearer one", "[part]") {
  // Cubes that overlap in a corner: both surfaces pass through the other's inside.
  Scene scene;
  const Vec3d shift(1.31, 0.77, 0.53);
  scene.objects.push_back({"first", test::cube()});
  scene.objects.push_back({"second", test::moved(test::cube(), shift)});
  const Conversion conversion = convert(scene, partsAt(0.05, 0));
  const openvdb::Int32Grid& part = partOf(conversion);
  const auto& mask = dynamic_cast<const openvdb::MaskGrid&>(*conversion.grids[1]);

  CHECK(part.getName() == "part");
  CHECK(part.background() == 0);
  CHECK(part.transform() == mask.transform());
  CHECK(differentVoxels(part, mask) == 0);
  CHECK(part.getMetadata<openvdb::StringMetadata>("vox_part_names")->value() ==
        R"({"1": "first", "2": "second"})");
  std::array<std::uint64_t, 2> voxels{};
  std::uint64_t wrong = 0;
  for (auto voxel = part.cbeginValueOn(); voxel; ++voxel) {
    const Vec3d centre = centreOf(part, voxel.getCoord());
    const double first = distanceFromCube(centre, Vec3d::Zero());
    const double second = distanceFromCube(centre, shift);
    if (std::abs(first - second) < 1e-5) continue;  // of floats
    wrong += *voxel != (first < second ? 1 : 2);
    ++voxels.at(first < second ? 0 : 1);
  }
  CHECK(wrong == 0);
  CHECK(voxels[0] > 5000);
  CHECK(voxels[1] > 5000);
}

TEST_CASE("balls that touch have the parts of the nearer surface", "[part]") {
  // Mirror images, so the plane between them is exact. The gap is narrower than a voxel.
  const Vec3d centre(1.01, 0, 0);
  Scene scene;
  scene.objects.push_back({"left", test::moved(ballOfQuads(), -centre)});
  PolygonMesh right = scene.objects[0].mesh;
  for (Vec3d& point : right.points) point.x() = -point.x();
  scene.objects.push_back({"right", test::insideOut(right)});
  const Conversion conversion = convert(scene, partsAt(0.04, 0));
  std::uint64_t wrong = 0;
  std::uint64_t checked = 0;
  for (auto voxel = partOf(conversion).cbeginValueOn(); voxel; ++voxel) {
    const double x = centreOf(partOf(conversion), voxel.getCoord()).x();
    if (std::abs(x) < 1e-5) continue;  // both are as near
    ++checked;
    wrong += *voxel != (x < 0 ? 1 : 2);
  }
  CHECK(checked > 5000);
  CHECK(wrong == 0);
}

TEST_CASE("the part of a cube's voxel is the face of its nearest point", "[part]") {
  const PolygonMesh mesh = cubeOfGroups();
  for (const Fill fill : {Fill::kSurface, Fill::kSolid}) {
    CAPTURE(nameIn(kFillNames, fill));
    ConvertOptions options = partsAt(0.041, 0);
    options.volume.fill = fill;
    const Conversion conversion = convert(test::oneObject(mesh), options);
    const openvdb::Int32Grid& part = partOf(conversion);
    std::set<openvdb::Int32> seen;
    std::uint64_t wrong = 0;
    std::uint64_t checked = 0;
    for (auto voxel = part.cbeginValueOn(); voxel; ++voxel) {
      openvdb::CoordBBox box;
      voxel.getBoundingBox(box);
      for (auto at = box.begin(); at != box.end(); ++at) {
        const Vec3d centre = centreOf(part, *at);
        Vec3d::Index axis = 0;
        const Vec3d size = centre.cwiseAbs();
        const double largest = size.maxCoeff(&axis);
        // Inner voxels have the part of the nearest voxel; that is up to a voxel off.
        std::array<double, 3> sorted = {size[0], size[1], size[2]};
        std::sort(sorted.begin(), sorted.end());
        const bool isInner = largest < 1 - 0.041;
        if (sorted[2] - sorted[1] < (isInner ? 1.5 * 0.041 : 1e-5)) continue;
        ++checked;
        const std::string face = std::string(centre[axis] > 0 ? "+" : "-") + "xyz"[axis];
        seen.insert(*voxel);
        wrong += mesh.attributes.groups.names[static_cast<std::size_t>(*voxel) - 1] != face;
      }
    }
    CHECK(wrong == 0);
    CHECK(seen.size() == 6);
    CHECK(checked > (fill == Fill::kSolid ? 80000 : 12000));
  }
}

TEST_CASE("the inside of a ball of two materials has the nearer one", "[part]") {
  PolygonMesh mesh = ballOfQuads();
  FaceSets& materials = mesh.attributes.materials;
  materials.names = {"lower", "upper"};
  for (Index f = 0; f < mesh.faceCount(); ++f)
    materials.ofFaces.push_back(test::faceCentroid(mesh, f).z() > 0 ? 1 : 0);
  ConvertOptions options;
  options.voxelSize = 0.05;
  options.grids = std::vector{GridKind::kDensity, GridKind::kPart};
  options.volume.fill = Fill::kSolid;
  options.until = StopRule{.levels = 0};
  for (const Edge edge : {Edge::kHard, Edge::kSoft}) {
    CAPTURE(nameIn(kEdgeNames, edge));
    options.volume.edge = edge;
    const Conversion conversion = convert(test::oneObject(mesh), options);
    const openvdb::Int32Grid& part = partOf(conversion, 1);
    const auto& density = dynamic_cast<const openvdb::FloatGrid&>(*conversion.grids[0]);
    CHECK(differentVoxels(part, density) == 0);
    const auto names =
        nlohmann::json::parse(part.getMetadata<openvdb::StringMetadata>("vox_part_names")->value());
    // Faces near z = 0 belong to one side by their centroid: they are up to 0.1 wide. The source of
    // an inner voxel is a voxel of the surface, half a diagonal from where it is nearest.
    constexpr double kTolerance = 0.15;
    std::uint64_t wrong = 0;
    std::uint64_t checked = 0;
    for (auto value = part.cbeginValueOn(); value; ++value) {
      openvdb::CoordBBox box;
      value.getBoundingBox(box);
      for (auto at = box.begin(); at != box.end(); ++at) {
        const Vec3d centre = centreOf(part, *at);
        // Rays from the middle: z of the nearest point is z / |centre|.
        if (std::abs(centre.z()) < kTolerance * std::max(centre.norm(), 0.3)) continue;
        ++checked;
        wrong += names[std::to_string(*value)] != (centre.z() > 0 ? "upper" : "lower");
      }
    }
    CHECK(checked > 25000);
    CHECK(wrong == 0);
  }
}

TEST_CASE("spreading gives every voxel a source that is nearly the nearest", "[part][property]") {
  // Random sources on the shell of a box; brute force over all of them.
  constexpr int kSide = 24;
  openvdb::Int32Tree tree(0);
  std::vector<std::pair<Coord, openvdb::Int32>> sources;
  std::mt19937 random(7);
  for (int x = 0; x < kSide; ++x)
    for (int y = 0; y < kSide; ++y)
      for (int z = 0; z < kSide; ++z) {
        const Coord at(x - 5, y - 11, z - 3);
        const bool isShell = std::min({x, y, z}) == 0 || std::max({x, y, z}) == kSide - 1;
        const auto label = isShell ? static_cast<openvdb::Int32>(random() % 5 + 1) : 0;
        tree.setValueOn(at, label);
        if (isShell) sources.emplace_back(at, label);
      }
  const openvdb::Int32Tree before(tree);
  spreadLabels(tree, Progress());
  CHECK(tree.activeVoxelCount() == before.activeVoxelCount());
  std::uint64_t wrong = 0;
  std::uint64_t changed = 0;
  for (auto voxel = tree.cbeginValueOn(); voxel; ++voxel) {
    const Coord at = voxel.getCoord();
    if (before.getValue(at) != 0) {
      changed += *voxel != before.getValue(at);
      continue;
    }
    double nearest = std::numeric_limits<double>::max();
    double nearestOfLabel = nearest;
    for (const auto& [source, label] : sources) {
      const double distance = (source - at).asVec3d().length();
      nearest = std::min(nearest, distance);
      if (label == *voxel) nearestOfLabel = std::min(nearestOfLabel, distance);
    }
    wrong += nearestOfLabel > nearest + 1e-9;
  }
  CHECK(changed == 0);
  CHECK(wrong == 0);  // from a convex shell, propagation is exact
}

TEST_CASE("voxels that no source leads to keep no label", "[part]") {
  openvdb::Int32Tree tree(0);
  tree.setValueOn(Coord(0, 0, 0), 4);
  tree.setValueOn(Coord(1, 1, 1), 0);  // a neighbour by its corner
  tree.setValueOn(Coord(3, 1, 1), 0);  // none
  spreadLabels(tree, Progress());
  CHECK(tree.getValue(Coord(1, 1, 1)) == 4);
  CHECK(tree.getValue(Coord(3, 1, 1)) == 0);
}

TEST_CASE("parts are numbered and named as the input has them", "[part]") {
  PolygonMesh mesh = test::cube();
  mesh.attributes.groups = {{"a", "b"}, {kNone, 1, 0, 1, 1, kNone}};
  mesh.attributes.materials = {{"m"}, {0, 0, 0, 0, 0, 0}};
  Scene scene = test::oneObject(mesh);
  CHECK(partsOf(scene, PartBy::kGroup).names == std::vector<std::string>{"object", "b", "a"});
  CHECK(partsOf(scene, PartBy::kGroup).ofFaces[0] == std::vector<std::int32_t>{1, 2, 3, 2, 2, 1});
  CHECK(partsOf(scene, PartBy::kObject).names == std::vector<std::string>{"object"});
  CHECK(defaultPartBy(scene) == PartBy::kGroup);
  scene.objects[0].mesh.attributes.groups = {};
  CHECK(defaultPartBy(scene) == PartBy::kObject);
  scene.objects[0].mesh.attributes.objects = {{"left", "right"}, {0, 0, 1, 1, 1, 1}};
  CHECK(partsOf(scene, PartBy::kObject).names == std::vector<std::string>{"left", "right"});

  scene.objects.push_back({"other", test::cube()});
  scene.objects.push_back({"other", mesh});
  CHECK(partsOf(scene, PartBy::kObject).names ==
        std::vector<std::string>{"object/left", "object/right", "other", "other"});
  CHECK(partsOf(scene, PartBy::kMaterial).names == std::vector<std::string>{"m", "other"});
}

TEST_CASE("names of parts are valid JSON whatever they hold", "[part]") {
  const std::vector<std::string> names = {"a \"b\"\\",
                                          "r\xc3\xa4"
                                          "d\n",
                                          "\xff\xfe", ""};
  const auto json = nlohmann::json::parse(partsJson(names));
  CHECK(json.size() == 4);
  CHECK(json["1"] == names[0]);
  CHECK(json["2"] == names[1]);
  CHECK(json["3"] == "\xef\xbf\xbd\xef\xbf\xbd");
  CHECK(json["4"] == "");
  CHECK(textOfName(names[0]) == names[0]);
  CHECK(nlohmann::json::parse(partsJson({})).empty());
}

TEST_CASE("grids of parts have unique names of letters, digits and _", "[part]") {
  CHECK(gridNamesOfParts({"body", "left arm", "left-arm", "left_arm_2", "2nd", "", "density", "N",
                          "r\xc3\xa4"
                          "d"}) == std::vector<std::string>{"body", "left_arm", "left_arm_2",
                                                            "left_arm_2_2", "_2nd", "_",
                                                            "density_2", "N_2", "r__d"});
  const std::vector<std::string> many = gridNamesOfParts(std::vector<std::string>(5000, "x"));
  CHECK(std::set<std::string>(many.begin(), many.end()).size() == 5000);
}

TEST_CASE("a split density is the density, part by part", "[part][split]") {
  const bool isSoft = GENERATE(false, true);
  const Fill fill = GENERATE(Fill::kSurface, Fill::kSolid);
  CAPTURE(isSoft, nameIn(kFillNames, fill));
  ConvertOptions options;
  options.dim = 60;
  options.volume.fill = fill;
  options.volume.edge = isSoft ? Edge::kSoft : Edge::kHard;
  options.grids = std::vector{GridKind::kDensity, GridKind::kPart};
  const Scene scene = test::oneObject(cubeOfGroups());
  const Conversion whole = convert(scene, options);
  options.grids = std::vector{GridKind::kDensity};
  options.split = Split::kPart;
  const Conversion split = convert(scene, options);
  const auto& density = dynamic_cast<const openvdb::FloatGrid&>(*whole.grids[0]);
  const openvdb::Int32Grid& part = partOf(whole, 1);

  REQUIRE(split.grids.size() == 6);
  std::uint64_t voxels = 0;
  std::uint64_t wrong = 0;
  for (std::size_t i = 0; i < split.grids.size(); ++i) {
    const auto& one = dynamic_cast<const openvdb::FloatGrid&>(*split.grids[i]);
    CHECK(one.getGridClass() == openvdb::GRID_FOG_VOLUME);
    CHECK(one.transform() == density.transform());
    CHECK(one.background() == 0);
    CHECK(one["vox_gain"]->str() == density["vox_gain"]->str());
    CHECK(one["vox_part_name"]->str() == scene.objects[0].mesh.attributes.groups.names[i]);
    voxels += one.activeVoxelCount();
    const auto values = density.getConstAccessor();
    const auto parts = part.getConstAccessor();
    for (auto value = one.cbeginValueOn(); value; ++value) {
      openvdb::CoordBBox box;
      value.getBoundingBox(box);
      for (auto at = box.begin(); at != box.end(); ++at)
        wrong += !values.isValueOn(*at) || values.getValue(*at) != *value ||
                 parts.getValue(*at) != static_cast<openvdb::Int32>(i) + 1;
    }
  }
  CHECK(wrong == 0);
  CHECK(voxels == density.activeVoxelCount());  // so the parts are disjoint
}

TEST_CASE("tiles of a density are split where their labels differ", "[part][split]") {
  openvdb::FloatTree density(0);
  density.addTile(2, Coord(0, 0, 0), 3, true);    // 128 voxels a side
  density.addTile(1, Coord(128, 0, 0), 5, true);  // 8 voxels a side
  density.setValueOn(Coord(200, 0, 0), 7);
  openvdb::Int32Tree labels(density, 0, 1, openvdb::TopologyCopy());
  labels.fill(openvdb::CoordBBox({3, 4, 5}, {90, 91, 92}), 2, true);
  labels.setValueOn(Coord(129, 1, 1), 2);
  const auto trees = splitDensity(density, labels, 3);
  REQUIRE(trees.size() == 3);
  CHECK(trees[2] == nullptr);
  CHECK(trees[0]->activeVoxelCount() + trees[1]->activeVoxelCount() == density.activeVoxelCount());
  CHECK(trees[1]->activeVoxelCount() == 88 * 88 * 88 + 1);
  CHECK(trees[1]->getValue(Coord(3, 4, 5)) == 3);
  CHECK(trees[1]->getValue(Coord(129, 1, 1)) == 5);
  CHECK(!trees[0]->isValueOn(Coord(129, 1, 1)));
  CHECK(trees[0]->getValue(Coord(128, 1, 1)) == 5);
  CHECK(trees[0]->getValue(Coord(200, 0, 0)) == 7);
  // What is constant stays tiles.
  CHECK(trees[0]->leafCount() + trees[1]->leafCount() <= 2 * labels.leafCount());
}

TEST_CASE("each of 4000 parts has the voxels over its own tile", "[part]") {
  constexpr int kSide = 63;
  ConvertOptions options = partsAt(0.25, 0);
  const Conversion conversion = convert(test::oneObject(tiles(kSide)), options);
  const openvdb::Int32Grid& part = partOf(conversion);
  std::map<openvdb::Int32, std::uint64_t> voxels;
  std::uint64_t wrong = 0;
  for (auto voxel = part.cbeginValueOn(); voxel; ++voxel) {
    ++voxels[*voxel];
    const Vec3d centre = centreOf(part, voxel.getCoord());
    const double x = std::floor(centre.x());
    const double y = std::floor(centre.y());
    if (centre.x() == x || centre.y() == y) continue;  // between two tiles
    wrong += *voxel != static_cast<openvdb::Int32>(y) * kSide + static_cast<openvdb::Int32>(x) + 1;
  }
  CHECK(voxels.size() == std::size_t{kSide} * kSide);
  CHECK(wrong == 0);

  options.grids = std::vector{GridKind::kDensity};
  options.split = Split::kPart;
  const Conversion split = convert(test::oneObject(tiles(kSide)), options);
  REQUIRE(split.grids.size() == std::size_t{kSide} * kSide);
  for (std::size_t i = 0; i < split.grids.size(); i += 100)
    CHECK(split.grids[i]->activeVoxelCount() == voxels[static_cast<openvdb::Int32>(i) + 1]);
}

TEST_CASE("a cropped grid of parts is a part of the whole one", "[part][crop]") {
  const Fill fill = GENERATE(Fill::kSurface, Fill::kSolid);
  const Edge edge = GENERATE(Edge::kHard, Edge::kSoft);
  CAPTURE(nameIn(kFillNames, fill), nameIn(kEdgeNames, edge));
  Scene scene = test::oneObject(cubeOfGroups());
  scene.objects.push_back({"second", test::moved(test::cube(), Vec3d(0.9, 0.3, 0.2))});
  ConvertOptions options;
  options.voxelSize = 0.06;
  options.volume.fill = fill;
  options.volume.edge = edge;
  options.grids = std::vector{GridKind::kDensity, GridKind::kPart};
  options.partBy = PartBy::kGroup;
  openvdb::Int32Grid::Ptr whole = partOf(convert(scene, options), 1).deepCopy();
  options.bounds = std::array{-0.4, -0.5, -0.2, 1.1, 0.7, 0.5};
  const openvdb::Int32Grid::Ptr cropped = partOf(convert(scene, options), 1).deepCopy();
  openvdb::MaskTree box;
  box.fill(cropped->evalActiveVoxelBoundingBox(), true, true);
  whole->tree().topologyIntersection(box);
  CHECK(cropped->activeVoxelCount() > 500);
  CHECK(differentValues(*whole, *cropped) == 0);
}

TEST_CASE("parts do not depend on threads", "[part][parallel]") {
  const auto bytes = [](int threads) {
    Scene scene = test::oneObject(cubeOfGroups());
    scene.objects.push_back({"torus", test::torusGrid(12, 6)});
    ConvertOptions options;
    options.dim = 70;
    options.volume.fill = Fill::kSolid;
    options.grids = std::vector{GridKind::kPart, GridKind::kDensity};
    options.split = Split::kPart;
    options.run.threads = threads;
    return test::bytesOf(convert(scene, options));
  };
  CHECK(bytes(1) == bytes(8));
}

TEST_CASE("a split without density, or by two kinds of parts, is refused", "[part][error]") {
  ConvertOptions options;
  options.dim = 20;
  options.split = Split::kPart;
  options.grids = std::vector{GridKind::kMask};
  CHECK_THROWS_WITH(convert(test::oneObject(test::cube()), options),
                    Contains("--split splits the grid density; name it in --grids"));
  options.grids = std::vector{GridKind::kDensity};
  options.split = Split::kObject;
  options.partBy = PartBy::kGroup;
  CHECK_THROWS_WITH(convert(test::oneObject(test::cube()), options), Contains("contradict"));
}

TEST_CASE("other grids can be asked of a scene that splits its density", "[part]") {
  Scene scene = test::oneObject(test::cube());
  scene.split = Split::kPart;
  ConvertOptions options;
  options.dim = 20;
  CHECK(namesOf(convert(scene, options)) == std::vector<std::string>{scene.objects[0].name});
  options.grids = std::vector{GridKind::kMask};
  CHECK(namesOf(convert(scene, options)) == std::vector<std::string>{"mask"});
  scene.grids = options.grids;
  options.grids.reset();
  CHECK_THROWS_WITH(convert(scene, options), Contains("--split splits the grid density"));
}

TEST_CASE("parts whose grids do not fit into memory are refused", "[part][error]") {
  ConvertOptions options;
  options.dim = 64;
  options.split = Split::kPart;
  options.run.maxMemory = 64U << 20U;
  CHECK_THROWS_WITH(convert(test::oneObject(tiles(40)), options), Contains("a grid for each part"));
}
