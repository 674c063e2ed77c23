#include "libvox/prepare/gaps.h"

#include "libvox/mesh/adjacency.h"
#include "libvox/prepare/sound.h"
#include "tests/shapes.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

using namespace vox;
using Catch::Contains;

namespace {

std::size_t loopsAfter(const PolygonMesh& mesh, double weld) {
  RepairOptions options;
  options.weldTolerance = weld;
  SoundReport report;
  const PolygonMesh sound = soundMesh(mesh, options, report);
  return boundaryLoops(sound, buildAdjacency(sound)).size();
}

/// A dodecahedron cut along the edges of one face, which is moved away.
PolygonMesh cutOpen(double gap) {
  PolygonMesh mesh = test::dodecahedron();
  const Vec3d away = gap * test::faceCentroid(mesh, 3).normalized();
  for (Index c = mesh.faceOffsets[3]; c < mesh.faceOffsets[4]; ++c) {
    mesh.points.push_back(mesh.points[mesh.faceVertices[c]] + away);
    mesh.faceVertices[c] = mesh.pointCount() - 1;
  }
  return mesh;
}

}  // namespace

TEST_CASE("the tolerance that is named closes the mesh, and half of it does not", "[gaps]") {
  for (const double scale : {1.0, 1e-6, 1e6})
    for (const double gap : {1e-2, 1e-4, 1e-9}) {
      CAPTURE(scale, gap);
      const PolygonMesh mesh = test::scaled(cutOpen(gap), scale);
      const GapReport report = measureGaps(mesh, {});
      CHECK(report.count == 2);
      CHECK(report.widest.width == Approx(gap * scale).epsilon(1e-4));
      REQUIRE(report.weld);
      CHECK(report.closes == 2);
      CHECK(loopsAfter(mesh, *report.weld) == 0);
      CHECK(loopsAfter(mesh, *report.weld / 2) == 2);
      CHECK(*report.weld < 1.2 * gap * scale);
    }
}

TEST_CASE("a hole is as wide as its box, and no tolerance closes it", "[gaps]") {
  const PolygonMesh mesh = test::withoutFaces(test::cube(), {2});
  const GapReport report = measureGaps(mesh, {});
  CHECK(report.count == 1);
  CHECK(report.widest.width == 2);
  CHECK_FALSE(report.weld);
  CHECK_THAT(summary(report), Contains("1 gap, 2 wide at "));
  CHECK(summary(measureGaps(test::cube(), {})).empty());
}

TEST_CASE("of holes and seams, the seams are closed", "[gaps]") {
  const PolygonMesh whole = test::dodecahedron();
  Index far = 0;  // a face that has no vertex of face 3
  const auto touches = [&](Index f) {
    const auto a = whole.face(f);
    const auto b = whole.face(3);
    return std::find_first_of(a.begin(), a.end(), b.begin(), b.end()) != a.end();
  };
  while (touches(far)) ++far;
  const PolygonMesh mesh = test::withoutFaces(cutOpen(0.001), {far});
  const GapReport report = measureGaps(mesh, {});
  CHECK(report.count == 3);
  CHECK(report.narrowest.width == Approx(0.001));
  REQUIRE(report.weld);
  CHECK(report.closes == 2);
  CHECK(loopsAfter(mesh, *report.weld) == 1);
  CHECK_THAT(summary(report), Contains("closes 2 of them"));
}

TEST_CASE("a dense slit of a fine mesh is as wide as the slit", "[gaps]") {
  // A grid with a row of small quads missing: 1 wide, 100 long.
  constexpr Index kColumns = 100;
  PolygonMesh mesh;
  for (Index j = 0; j <= 41; ++j)
    for (Index i = 0; i <= kColumns; ++i) mesh.points.emplace_back(i, j, 0);
  for (Index j = 0; j < 41; ++j)
    for (Index i = 0; i < kColumns; ++i)
      if (j != 20 || i == 0 || i + 1 == kColumns) {
        const Index v = j * (kColumns + 1) + i;
        mesh.addFace(std::vector<Index>{v, v + 1, v + kColumns + 2, v + kColumns + 1});
      }
  const GapReport report = measureGaps(mesh, {});
  CHECK(report.count == 2);
  CHECK(report.narrowest.width == Approx(1));
}

TEST_CASE("printed coordinates have the digits of a float", "[gaps]") {
  CHECK(exactNumber(500000.25) == "500000.25");
  CHECK(exactNumber(4649776.5) == "4649776.5");
  CHECK(exactNumber(500000) == "500000");
  CHECK(exactNumber(0.1) == "0.1");
  CHECK(exactNumber(-1e-9) == "-1e-09");
  CHECK(exactPoint(Vec3d(1, 0, -0.5)) == "(1, 0, -0.5)");
}
