#include "libvox/inspect/separation.h"

#include "libvox/core/progress.h"
#include "libvox/grid/openvdb.h"
#include "libvox/inspect/components.h"
#include "libvox/pipeline/convert.h"
#include "libvox/pipeline/refined_polygons.h"
#include "libvox/prepare/sound.h"
#include "libvox/subdivide/doo_sabin.h"
#include "libvox/subdivide/stop.h"
#include "libvox/voxelize/scan.h"
#include "tests/reference.h"
#include "tests/shapes.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <optional>

using namespace vox;
using openvdb::Coord;
using openvdb::MaskTree;

namespace {

/// The voxels of a shape, and its surface of faces that fit into a voxel.
struct Case {
  MaskTree voxels;
  PolygonMesh mesh;
  ReferenceSurface surface;
};

/// Largest distance of control points from the surface, if their faces fit into a voxel.
constexpr double kTolerance = 0.25;

bool fine(const PolygonMesh& mesh) {
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    std::vector<Vec3d> corners;
    for (const Index v : mesh.face(f)) corners.push_back(mesh.points[v]);
    if (diameter(corners) > kVertexConversionSpan) return false;
  }
  return true;
}

Case caseOf(PolygonMesh mesh, double size, std::optional<int> levels = {},
            Separation separation = Separation::k6) {
  for (Vec3d& p : mesh.points) p = p * size + Vec3d(0.13, 0.29, -0.41);
  const double tolerance = levels ? 0.0 : kTolerance;
  Scene scene;
  scene.objects.push_back({"shape", mesh});
  ConvertOptions options;
  options.voxelSize = 1;
  options.grids = std::vector{GridKind::kMask};
  options.separation = separation;
  if (levels) options.until = StopRule{levels};
  const Conversion conversion = convert(scene, options);
  SoundReport report;
  SubdivisionLevel level = baseLevel(soundMesh(mesh, {}, report), BoundaryRule::kExtend);
  for (int k = 0; levels ? k < *levels : !fine(level.mesh); ++k)
    level = nextLevel(level, imageVertices(level));
  return {openvdb::gridPtrCast<openvdb::MaskGrid>(conversion.grids[0])->tree(), level.mesh,
          referenceSurface(level.mesh, tolerance)};
}

/// Every n-th of the thin voxels, which have inactive voxels on both sides along some axis; or of
/// the others.
std::vector<Coord> everyNth(const MaskTree& voxels, bool thin, std::size_t n) {
  std::vector<Coord> some;
  std::size_t i = 0;
  for (auto voxel = voxels.cbeginValueOn(); voxel; ++voxel) {
    const Coord at = voxel.getCoord();
    const auto isThin = [&](const Coord& step) {
      return !voxels.isValueOn(at + step) && !voxels.isValueOn(at - step);
    };
    if ((isThin({1, 0, 0}) || isThin({0, 1, 0}) || isThin({0, 0, 1})) == thin && i++ % n == 0)
      some.push_back(at);
  }
  return some;
}

bool subdivides(const PolygonMesh& mesh) {
  return test::faultOf(mesh).empty();
}

}  // namespace

TEST_CASE("vertex conversion leaves no tunnels in any shape, closed or open",
          "[inspect][separation][property]") {
  std::size_t checked = 0;
  for (const auto* shapes : {&test::shapes(), &test::openShapes()})
    for (const auto& shape : *shapes) {
      if (!subdivides(shape.mesh)) continue;
      for (const double size : {2.0, 3.0, 4.4, 7.7, 11.1}) {
        CAPTURE(shape.name, size);
        const Case made = caseOf(shape.mesh, size);
        CHECK(findTunnels(made.voxels, made.surface, Separation::k6).tunnels == 0);
        ++checked;
      }
    }
  CHECK(checked > 40);
}

TEST_CASE("polygon conversion leaves no tunnels", "[inspect][separation][property]") {
  for (const auto separation : {Separation::k6, Separation::k26})
    for (const int levels : {0, 2})
      for (const auto* shapes : {&test::shapes(), &test::openShapes()})
        for (const auto& shape : *shapes) {
          if (!subdivides(shape.mesh)) continue;
          CAPTURE(shape.name, levels);
          const Case made = caseOf(shape.mesh, 5.3, levels, separation);
          CHECK(findTunnels(made.voxels, made.surface, separation).tunnels == 0);
        }
}

TEST_CASE("removing a voxel makes a tunnel exactly if a flood from inside gets out there",
          "[inspect][separation][property]") {
  // The slow implementation labels all of space by winding numbers.
  std::size_t tunnels = 0;
  std::size_t sound = 0;
  for (const PolygonMesh& shape : {test::torusGrid(8, 6), test::dodecahedron()}) {
    const Case made = caseOf(shape, 3.2);
    std::vector<Coord> voxels = everyNth(made.voxels, true, 9);
    const std::vector<Coord> others = everyNth(made.voxels, false, 97);
    voxels.insert(voxels.end(), others.begin(), others.end());
    for (const Coord& gone : voxels) {
      Case holed = made;
      holed.voxels.setValueOff(gone);
      const auto mask = openvdb::MaskGrid::create(std::make_shared<MaskTree>(holed.voxels));
      const bool leaks = test::sidesOf(made.mesh, *mask).leaks > 0;
      const SeparationReport report = findTunnels(holed.voxels, made.surface, Separation::k6);
      CAPTURE(gone);
      CHECK((report.tunnels > 0) == leaks);
      ++(leaks ? tunnels : sound);
      if (!leaks) continue;
      REQUIRE(report.first);
      const auto& [x, y, z] = *report.first;
      const Coord distance = Coord(x, y, z) - gone;
      CHECK(std::max({std::abs(distance.x()), std::abs(distance.y()), std::abs(distance.z())}) <=
            1);
    }
  }
  CHECK(tunnels > 10);
  CHECK(sound > 2);
}

TEST_CASE("removing any voxel of a thin plane, away from its rim, makes a tunnel",
          "[inspect][separation]") {
  PolygonMesh plane;
  plane.points = {{-9.6, -9.6, 0.2}, {9.4, -9.6, 0.2}, {9.4, 9.4, 0.2}, {-9.6, 9.4, 0.2}};
  plane.faceOffsets = {0};
  plane.addFace(std::vector<Index>{0, 1, 2, 3});
  const ReferenceSurface surface = referenceSurface(plane, 0);
  MaskTree voxels;
  for (int x = -10; x <= 9; ++x)
    for (int y = -10; y <= 9; ++y) voxels.setValueOn({x, y, 0});
  for (const auto separation : {Separation::k6, Separation::k26}) {
    CHECK(findTunnels(voxels, surface, separation).tunnels == 0);
    for (int x = -6; x <= 5; ++x)
      for (int y = -6; y <= 5; ++y) {
        MaskTree holed(voxels);
        holed.setValueOff({x, y, 0});
        const SeparationReport report = findTunnels(holed, surface, separation);
        CAPTURE(x, y);
        CHECK(report.tunnels == 1);
        CHECK(report.first == VoxelIndex{x, y, 0});
      }
  }
}

TEST_CASE("polygons of different depths meet without gaps", "[inspect][separation]") {
  // If there were gaps, steps through them would not cross the surface: no tunnel would be found.
  const StopRule until = {.diameter = 4, .angle = 8};
  PolygonMesh mesh = test::dodecahedron();
  for (Vec3d& p : mesh.points) p *= 9.3;
  Scene scene;
  scene.objects.push_back({"shape", mesh});
  ConvertOptions options;
  options.voxelSize = 1;
  options.grids = std::vector{GridKind::kMask};
  options.until = until;
  const Conversion conversion = convert(scene, options);
  const auto& voxels = openvdb::gridPtrCast<openvdb::MaskGrid>(conversion.grids[0])->tree();
  Progress unwatched;
  TriangleSoup soup = triangleSoup(baseLevel(mesh, BoundaryRule::kExtend), until, {}, unwatched);
  const ReferenceSurface surface = {std::move(soup.points), std::move(soup.triangles), 0};
  CHECK(findTunnels(voxels, surface, Separation::k6).tunnels == 0);
  std::size_t tunnels = 0;
  for (const Coord& gone : everyNth(voxels, true, 41)) {
    MaskTree holed(voxels);
    holed.setValueOff(gone);
    CAPTURE(gone);
    const bool leaks = Cavities(holed).enclosed().empty();
    CHECK((findTunnels(holed, surface, Separation::k6).tunnels > 0) == leaks);
    tunnels += leaks;
  }
  CHECK(tunnels > 3);
}

TEST_CASE("gaps of polygons of different depths show against a level of the whole mesh",
          "[inspect][separation]") {
  const StopRule until = {.diameter = 4, .angle = 8};
  PolygonMesh mesh = test::dodecahedron();
  for (Vec3d& p : mesh.points) p *= 9.3;
  const SubdivisionLevel base = baseLevel(mesh, BoundaryRule::kExtend);
  Progress unwatched;
  TriangleSoup soup = triangleSoup(base, until, {}, unwatched);
  ReferenceSurface plain = referenceSurface(subdivide(base, 3).mesh, 0);
  const std::optional<int> reach = reachOf(plain, {soup.points, soup.triangles, 0});
  REQUIRE(reach);
  CHECK(*reach <= 2);
  plain.tolerance = std::max(1, *reach);
  const auto voxelsOfSoup = [&] {
    MaskTree voxels;
    scanTriangles(soup.points, soup.triangles, Separation::k6, [&](const VoxelBlock& block) {
      forEachVoxel(block, [&](int x, int y, int z) { voxels.setValueOn({x, y, z}); });
    });
    return voxels;
  };
  CHECK(findTunnels(voxelsOfSoup(), plain, Separation::k6).tunnels == 0);
  // A gap in the polygons: they and their voxels fit each other.
  const Vec3d hole = soup.points[soup.triangles[0][0]];
  std::erase_if(soup.triangles,
                [&](const auto& corners) { return (soup.points[corners[0]] - hole).norm() < 4; });
  const MaskTree holed = voxelsOfSoup();
  CHECK(Cavities(holed).enclosed().empty());
  const ReferenceSurface itself = {soup.points, soup.triangles, 0};
  CHECK(findTunnels(holed, itself, Separation::k6).tunnels == 0);
  CHECK(findTunnels(holed, plain, Separation::k6).tunnels > 0);
}

TEST_CASE("one-sided surfaces have tunnels, too", "[inspect][separation]") {
  // Preparation doubles the sheet; both sides lie at the same place.
  const Case made = caseOf(test::moebius(12), 25, 0);
  CHECK(findTunnels(made.voxels, made.surface, Separation::k6).tunnels == 0);
  std::size_t found = 0;
  for (const Coord& gone : everyNth(made.voxels, true, 7)) {
    MaskTree holed(made.voxels);
    holed.setValueOff(gone);
    found += findTunnels(holed, made.surface, Separation::k6).tunnels > 0;
  }
  CHECK(found > 0);
}
