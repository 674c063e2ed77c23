#include "libvox/pipeline/convert.h"

#include "libvox/core/error.h"
#include "libvox/subdivide/doo_sabin.h"
#include "tests/reference.h"
#include "tests/shapes.h"

#include <catch2/catch.hpp>
#include <openvdb/openvdb.h>

#include <sstream>

using namespace vox;
using Catch::Contains;
using openvdb::Coord;

namespace {

Scene sceneOf(const PolygonMesh& mesh) {
  Scene scene;
  scene.objects.push_back({"object", mesh});
  return scene;
}

ConvertOptions maskAt(int dim) {
  ConvertOptions options;
  options.dim = dim;
  options.grids = std::vector{GridKind::kMask};
  return options;
}

const openvdb::MaskGrid& maskOf(const Conversion& conversion) {
  return dynamic_cast<const openvdb::MaskGrid&>(*conversion.grids.at(0));
}

/// The mesh whose vertices were converted, in voxels.
PolygonMesh refinedIndex(const PolygonMesh& mesh, const Conversion& conversion) {
  PolygonMesh refined = subdivide(baseLevel(mesh), conversion.report.objects[0].levels).mesh;
  for (Vec3d& p : refined.points) p /= conversion.report.voxelSize;
  return refined;
}

std::string bytesOf(const Conversion& conversion) {
  std::stringstream stream(std::ios::in | std::ios::out | std::ios::binary);
  writeGrids(stream, conversion);
  return stream.str();
}

/// Whether a path of white voxels, face to face, leads from one voxel to another within a box.
bool whitePath(const openvdb::MaskGrid& mask, const openvdb::CoordBBox& box, Coord from, Coord to) {
  openvdb::MaskTree reached;
  std::vector<Coord> open = {from};
  reached.setValueOn(from);
  while (!open.empty()) {
    const Coord at = open.back();
    open.pop_back();
    if (at == to) return true;
    for (int axis = 0; axis < 3; ++axis)
      for (const int step : {-1, 1}) {
        Coord next = at;
        next[axis] += step;
        if (!box.isInside(next) || mask.tree().isValueOn(next) || reached.isValueOn(next)) continue;
        reached.setValueOn(next);
        open.push_back(next);
      }
  }
  return false;
}

}  // namespace

TEST_CASE("no path of white voxels joins the sides of a closed surface", "[pipeline][property]") {
  for (const auto& shape : test::shapes())
    for (const int dim : {8, 13}) {
      if (!shape.closed) continue;
      CAPTURE(shape.name, dim);
      const Conversion conversion = convert(sceneOf(shape.mesh), maskAt(dim));
      const test::Sides sides =
          test::sidesOf(refinedIndex(shape.mesh, conversion), maskOf(conversion));
      CHECK(sides.outside > 0);
      CHECK((sides.inside > 0 || dim < 13));
      CHECK(sides.leaks == 0);
    }
}

TEST_CASE("removing a voxel that the surface needs opens a leak that the check sees",
          "[pipeline]") {
  const PolygonMesh shape = test::dodecahedron();
  const Conversion conversion = convert(sceneOf(shape), maskAt(9));
  const PolygonMesh refined = refinedIndex(shape, conversion);
  const openvdb::MaskGrid& mask = maskOf(conversion);
  std::size_t tried = 0;
  std::size_t opened = 0;
  for (auto voxel = mask.cbeginValueOn(); voxel; ++voxel) {
    if (++tried % 7 != 0) continue;
    const openvdb::MaskGrid::Ptr holed = mask.deepCopy();
    holed->tree().setValueOff(voxel.getCoord());
    opened += test::sidesOf(refined, *holed).leaks > 0;
  }
  CHECK(opened > tried / 7 / 4);
}

TEST_CASE("an open sheet has no hole from one side to the other", "[pipeline][property]") {
  const Conversion conversion = convert(sceneOf(test::sheet(5, 4)), maskAt(40));
  // Plain Doo-Sabin ends half a face inside the boundary; look at the columns within.
  const double unit = 1 / conversion.report.voxelSize;
  const auto at = [&](double x) { return static_cast<int>(x * unit); };
  const openvdb::CoordBBox box(at(1), at(1), at(-1), at(4), at(3), at(1));
  CHECK_FALSE(whitePath(maskOf(conversion), box, box.min(), box.max()));
}

TEST_CASE("white voxels inside and outside a closed surface are not connected",
          "[pipeline][property]") {
  for (const auto& mesh : {test::cube(), test::dodecahedron(), test::prism(12)}) {
    const Conversion conversion = convert(sceneOf(mesh), maskAt(40));
    openvdb::CoordBBox box = maskOf(conversion).evalActiveVoxelBoundingBox();
    box.expand(1);
    CHECK_FALSE(maskOf(conversion).tree().isValueOn({0, 0, 0}));
    CHECK_FALSE(whitePath(maskOf(conversion), box, box.min(), {0, 0, 0}));
    CHECK(whitePath(maskOf(conversion), box, box.min(), box.max()));
  }
}

TEST_CASE("a smoothed cube passes through the centres of its faces", "[pipeline][golden]") {
  const Conversion conversion = convert(sceneOf(test::cube()), maskAt(64));
  CHECK(conversion.report.voxelSize == 2.0 / 64);
  for (int axis = 0; axis < 3; ++axis)
    for (const int end : {-32, 32}) {
      Coord centre(0, 0, 0);
      centre[axis] = end;
      CHECK(maskOf(conversion).tree().isValueOn(centre));
    }
  CHECK_FALSE(maskOf(conversion).tree().isValueOn({32, 32, 32}));
}

TEST_CASE("objects of a scene share one grid", "[pipeline]") {
  PolygonMesh far = test::cube();
  for (Vec3d& p : far.points) p.x() += 10;
  Scene both = sceneOf(test::cube());
  both.objects.push_back({"far", far});
  ConvertOptions options = maskAt(1);
  options.dim.reset();
  options.voxelSize = 0.125;
  const auto near = convert(sceneOf(test::cube()), options).report.activeVoxels;
  const Conversion conversion = convert(both, options);
  CHECK(conversion.report.activeVoxels == 2 * near);
  CHECK(maskOf(conversion).tree().isValueOn({8, 0, 0}));
  CHECK(maskOf(conversion).tree().isValueOn({88, 0, 0}));
}

TEST_CASE("options come before the scene, the scene before the defaults", "[pipeline]") {
  Scene scene = sceneOf(test::cube());
  CHECK(convert(scene, {}).report.voxelSize == 2.0 / kDefaultDim);
  scene.voxelSize = 0.5;
  scene.grids = std::vector{GridKind::kMask};
  CHECK(convert(scene, {}).report.voxelSize == 0.5);
  CHECK(convert(scene, {}).grids.at(0)->getName() == "mask");
  const Conversion conversion = convert(scene, maskAt(10));
  CHECK(conversion.report.voxelSize == 0.2);
}

TEST_CASE("two runs, and any number of threads, give the same bytes", "[pipeline][parallel]") {
  Scene scene = sceneOf(test::shuffled(test::torusGrid(24, 12), 5));
  scene.objects.push_back({"more", test::prism(9)});
  ConvertOptions options;
  options.dim = 200;
  options.grids = std::vector{GridKind::kDensity, GridKind::kMask};
  const std::string first = bytesOf(convert(scene, options));
  for (const int threads : {1, 2, 8}) {
    options.threads = threads;
    CHECK(bytesOf(convert(scene, options)) == first);
  }
}

TEST_CASE("a conversion that cannot fit is refused before it starts", "[pipeline][error]") {
  ConvertOptions options = maskAt(100000);
  options.maxMemory = std::uint64_t{1} << 28;
  CHECK_THROWS_AS(convert(sceneOf(test::cube()), options), LimitError);
  CHECK_THROWS_WITH(convert(sceneOf(test::cube()), options),
                    Contains("limit is 256.0 MiB") && Contains("times as large"));
  CHECK_THROWS_AS(refine(sceneOf(test::cube()), 25, options), LimitError);
}

TEST_CASE("impossible requests are refused", "[pipeline][error]") {
  CHECK_THROWS_AS(convert(sceneOf(test::cube()), maskAt(0)), UsageError);
  CHECK_THROWS_AS(convert(sceneOf(test::moebius(6)), maskAt(8)), MeshError);
  ConvertOptions fine;
  fine.voxelSize = 1e-12;
  CHECK_THROWS_AS(convert(sceneOf(test::cube()), fine), LimitError);
  CHECK_THROWS_AS(refine(sceneOf(test::cube()), -1, {}), UsageError);
}

TEST_CASE("refining a scene joins its objects into one mesh", "[pipeline]") {
  Scene scene = sceneOf(test::cube());
  scene.objects.push_back({"more", test::tetrahedron()});
  const PolygonMesh mesh = refine(scene, 1, {});
  CHECK(mesh.pointCount() == 24 + 12);
  CHECK(mesh.faceCount() == 26 + 14);
  CHECK(mesh.face(26)[0] == 24);
  CHECK(refine(scene, 0, {}).points == [] {
    auto points = test::cube().points;
    const auto more = test::tetrahedron().points;
    points.insert(points.end(), more.begin(), more.end());
    return points;
  }());
}
