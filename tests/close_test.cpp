#include "libvox/volume/close.h"

#include "libvox/grid/openvdb.h"
#include "libvox/pipeline/convert.h"
#include "libvox/volume/fill.h"
#include "tests/scenes.h"
#include "tests/shapes.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>
#include <utility>

using namespace vox;
using Catch::Contains;
using openvdb::Coord;
using openvdb::CoordBBox;
using openvdb::MaskTree;

namespace {

/// The sides of a box of voxels, 0 to 40 along each axis.
MaskTree hollowBox() {
  MaskTree box;
  const CoordBBox all(Coord(0), Coord(40));
  const CoordBBox inner(Coord(1), Coord(39));
  for (auto at = all.begin(); at != all.end(); ++at)
    if (!inner.isInside(*at)) box.setValueOn(*at);
  return box;
}

/// Without the voxels of a box.
MaskTree opened(const MaskTree& surface, const CoordBBox& hole) {
  MaskTree open(surface);
  for (auto at = hole.begin(); at != hole.end(); ++at) open.setValueOff(*at);
  return open;
}

std::uint64_t solidVoxels(const MaskTree& surface, int width) {
  const Closure closure = closureOf(surface, width);
  MaskTree tight(surface);
  if (closure.voxels) tight.topologyUnion(*closure.voxels);
  return filled(tight, {})->activeVoxelCount();
}

/// A sphere of radius 1, of quads, without the faces within an angle of its north pole.
PolygonMesh sphere(double opening) {
  constexpr Index kAround = 64;
  constexpr Index kRows = 48;
  PolygonMesh mesh;
  for (Index i = 0; i <= kRows; ++i)
    for (Index j = 0; j < kAround; ++j) {
      const double polar = opening + (std::numbers::pi - opening) * i / (kRows + 0.5);
      const double turn = 2 * std::numbers::pi * j / kAround;
      mesh.points.emplace_back(std::sin(polar) * std::cos(turn), std::sin(polar) * std::sin(turn),
                               std::cos(polar));
    }
  std::vector<Index> south;
  for (Index j = 0; j < kAround; ++j) {
    for (Index i = 0; i < kRows; ++i) {
      const Index next = (j + 1) % kAround;
      mesh.addFace(std::vector<Index>{i * kAround + j, (i + 1) * kAround + j,
                                      (i + 1) * kAround + next, i * kAround + next});
    }
    south.push_back(kRows * kAround + kAround - 1 - j);
  }
  mesh.addFace(south);
  return mesh;
}

ConvertOptions solidOptions(int close) {
  ConvertOptions options;
  options.voxelSize = 0.02;
  options.grids = {GridKind::kDensity, GridKind::kSurface, GridKind::kMask};
  options.volume.fill = Fill::kSolid;
  options.volume.close = close;
  return options;
}

const openvdb::FloatGrid& floats(const Conversion& conversion, std::size_t i) {
  return dynamic_cast<const openvdb::FloatGrid&>(*conversion.grids.at(i));
}

}  // namespace

TEST_CASE("an opening of k voxels closes if it is narrower than N", "[close]") {
  const std::uint64_t full = 41 * 41 * 41;
  const MaskTree box = hollowBox();
  for (const int k : {1, 2, 3, 4, 7}) {
    const MaskTree slit = opened(box, CoordBBox(Coord(5, 18, 40), Coord(35, 18 + k - 1, 40)));
    const MaskTree square = opened(box, CoordBBox(Coord(0, 9, 9), Coord(0, 9 + k - 1, 9 + k - 1)));
    for (int n = 2; n <= 9; ++n) {
      CAPTURE(k, n);
      CHECK(solidVoxels(slit, n) == (n > k ? full : slit.activeVoxelCount()));
      // With even widths the hole may be closed one voxel deeper, so that its own voxels stay open.
      const auto hole = static_cast<std::uint64_t>(k * k);
      const std::uint64_t solid = solidVoxels(square, n);
      CHECK(solid == (n <= k ? square.activeVoxelCount() : n % 2 == 0 ? full - hole : full));
      CHECK(closureOf(slit, n).openings == (n > k ? 1 : 0));
      if (n > k) CHECK(closureOf(slit, n).voxelCount == static_cast<std::uint64_t>(31 * k));
    }
  }
}

TEST_CASE("several openings close at once, each at its narrowest place", "[close]") {
  const MaskTree one = opened(hollowBox(), CoordBBox(Coord(10, 10, 40), Coord(12, 12, 40)));
  const MaskTree box = opened(one, CoordBBox(Coord(0, 20, 5), Coord(0, 21, 30)));
  const Closure closure = closureOf(box, 5);
  CHECK(closure.openings == 2);
  CHECK(closure.voxelCount == 9 + 52);
  for (const auto& [inner, outer] : closure.sides) {
    CHECK(closure.voxels->isValueOn(inner));
    CHECK_FALSE(closure.voxels->isValueOn(outer));
  }
}

TEST_CASE("grooves of the outside, closed surfaces and open sheets stay as they are", "[close]") {
  // A groove of 2 x 5 voxels, with walls.
  MaskTree grooved = opened(hollowBox(), CoordBBox(Coord(0, 20, 40), Coord(40, 21, 40)));
  for (int x = 0; x <= 40; ++x)
    for (int z = 35; z <= 40; ++z)
      for (const int y : {19, 20, 21, 22})
        if (z == 35 || y == 19 || y == 22) grooved.setValueOn(Coord(x, y, z));
  for (int z = 36; z <= 40; ++z)
    for (const int y : {20, 21})
      for (const int x : {0, 40}) grooved.setValueOff(Coord(x, y, z));
  MaskTree sheet;
  for (int x = 0; x < 40; ++x)
    for (int y = 0; y < 40; ++y) sheet.setValueOn(Coord(x, y, 0));
  for (const int n : {2, 3, 6, 11, 30}) {
    CAPTURE(n);
    CHECK(closureOf(grooved, n).voxelCount == 0);
    CHECK(closureOf(hollowBox(), n).voxelCount == 0);
    CHECK(closureOf(sheet, n).voxelCount == 0);
    CHECK(closureOf(MaskTree(), n).voxelCount == 0);
  }
}

TEST_CASE("a ball with a hole becomes solid, in density and level set, if the hole is narrower",
          "[close][pipeline]") {
  constexpr double kOpening = 0.15;  // a hole of 15 voxels
  const Scene scene = test::oneObject(sphere(kOpening));
  const double ball = 4.0 / 3 * std::numbers::pi * std::pow(1 / 0.02, 3);
  const Conversion open = convert(scene, solidOptions(8));
  const Conversion closed = convert(scene, solidOptions(17));

  CHECK(static_cast<double>(floats(open, 0).activeVoxelCount()) < 0.2 * ball);
  const double density = static_cast<double>(floats(closed, 0).activeVoxelCount()) / ball;
  CHECK(density > 1);
  CHECK(density < 1.05);  // the voxels of the surface reach out by half a voxel or so
  CHECK_THAT(closed.report.warnings.at(0), Contains("closed 1 opening of the voxel surface with "));
  CHECK(closed.report.warnings.size() == 1);

  const auto& distance = floats(closed, 1).tree();
  CHECK(distance.getValue(Coord(0, 0, 0)) < 0);
  CHECK(floats(open, 1).tree().getValue(Coord(0, 0, 0)) > 0);
  std::uint64_t inside = 0;
  std::uint64_t jumps = 0;
  const CoordBBox around(Coord(-54), Coord(54));
  for (auto at = around.begin(); at != around.end(); ++at) {
    const double value = double{distance.getValue(*at)} / 0.02;
    if (value < 0) ++inside;
    for (int axis = 0; axis < 3; ++axis) {
      Coord next = *at;
      ++next[axis];
      const double other = double{distance.getValue(next)} / 0.02;
      if ((value < 0) != (other < 0) && std::abs(value - other) > 1.05) ++jumps;
    }
  }
  CHECK(static_cast<double>(inside) / ball == Approx(1).margin(0.02));
  CHECK(jumps == 0);
  // The voxels of the surface are those without --close.
  CHECK(closed.grids[2]->activeVoxelCount() == open.grids[2]->activeVoxelCount());
}

TEST_CASE("closing does not change closed meshes, and says where it does not help",
          "[close][pipeline]") {
  const Scene solid = test::oneObject(test::torusGrid(12, 7));
  ConvertOptions options = solidOptions(0);
  const Conversion plain = convert(solid, options);
  options.volume.close = 40;
  const Conversion closing = convert(solid, options);
  CHECK(closing.report.warnings.empty());
  CHECK(floats(plain, 0).tree().hasSameTopology(floats(closing, 0).tree()));
  CHECK(floats(plain, 1).tree().hasSameTopology(floats(closing, 1).tree()));

  const Scene sheet = test::oneObject(test::sheet(5, 5));
  options.volume.openMesh = OpenMesh::kError;
  CHECK_THROWS_WITH(convert(sheet, options), Contains("--close 40 does not close all of it"));
  options.volume.openMesh = OpenMesh::kSurface;
  const Conversion kept = convert(sheet, options);
  CHECK_THAT(kept.report.warnings.at(0), Contains("closed nothing"));
  CHECK(kept.report.warnings.size() == 2);
}

TEST_CASE("a pierced ball and a sheet share a level set, each in many submeshes",
          "[close][pipeline]") {
  const PolygonMesh both = test::together(sphere(0.01), test::sheet(30, 30), Vec3d(3, 0, 0), 0.1);
  ConvertOptions options = solidOptions(0);
  const Conversion conversion = convert(test::oneObject(both), options);
  CHECK(floats(conversion, 1).tree().getValue(Coord(0, 0, 0)) < 0);
}
