#include "libvox/prepare/orient.h"

#include "libvox/mesh/adjacency.h"
#include "libvox/prepare/enclosure.h"
#include "libvox/prepare/repair.h"
#include "libvox/subdivide/doo_sabin.h"
#include "tests/shapes.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

using namespace vox;
using Catch::Contains;

namespace {

struct Oriented {
  PolygonMesh mesh;
  OrientReport report;
};

Oriented oriented(const PolygonMesh& mesh) {
  Oriented out;
  out.mesh = orient(mesh, out.report);
  CHECK(out.report.adjacency.twin == buildAdjacency(out.mesh).twin);
  CHECK(out.report.adjacency.cornerFace == buildAdjacency(out.mesh).cornerFace);
  return out;
}

void checkSound(const PolygonMesh& mesh) {
  CHECK(test::faultOf(mesh) == "");
}

double volume(const PolygonMesh& mesh) {
  std::vector<Index> all(mesh.faceCount());
  std::iota(all.begin(), all.end(), 0);
  return signedVolume(mesh, all).volume;
}

}  // namespace

TEST_CASE("volume is that of the solid, negative inside out", "[orient]") {
  CHECK(volume(test::cube()) == Approx(8));
  CHECK(volume(test::insideOut(test::cube())) == Approx(-8));
  CHECK(volume(test::tetrahedron()) == Approx(8.0 / 3));
}

TEST_CASE("a ray knows inside from outside, through edges and vertices too", "[orient]") {
  const PolygonMesh cube = test::cube();
  const std::vector<Index> all = {0, 1, 2, 3, 4, 5};
  for (double y = -1.5; y <= 1.5; y += 0.25)
    for (double z = -1.5; z <= 1.5; z += 0.25) {
      if (std::max(std::abs(y), std::abs(z)) == 1) continue;  // on the surface
      const bool within = std::max(std::abs(y), std::abs(z)) < 1;
      CHECK(encloses(cube, all, {0, y, z}) == within);
      CHECK_FALSE(encloses(cube, all, {-2, y, z}));
      CHECK_FALSE(encloses(cube, all, {2, y, z}));
    }
}

TEST_CASE("closed shapes face outward and keep everything but their winding", "[orient]") {
  for (const auto& shape : test::shapes()) {
    if (shape.name == "bow tie") continue;
    CAPTURE(shape.name);
    const auto out = oriented(shape.mesh);
    CHECK(out.mesh.points == shape.mesh.points);
    CHECK(out.mesh.faceOffsets == shape.mesh.faceOffsets);
    CHECK(out.report.flippedFaces == 0);
    CHECK(out.report.components == 1);
    CHECK(out.report.closedComponents == (shape.closed ? 1 : 0));
    CHECK(out.report.secondSide == out.mesh.faceCount());
    CHECK(summary(out.report).empty());
    if (shape.closed) CHECK(volume(out.mesh) > 0);
    checkSound(out.mesh);
  }
}

TEST_CASE("every face starts at its lowest vertex", "[orient]") {
  const auto out = oriented(test::dodecahedron());
  for (Index f = 0; f < out.mesh.faceCount(); ++f) {
    const auto face = out.mesh.face(f);
    CHECK(face[0] == *std::min_element(face.begin(), face.end()));
  }
}

TEST_CASE("flipping and rotating any faces of a closed mesh changes nothing",
          "[orient][property]") {
  for (const auto& shape : test::shapes()) {
    if (!shape.closed || shape.name == "bow tie") continue;
    CAPTURE(shape.name);
    const auto expected = oriented(shape.mesh);
    for (std::uint32_t seed = 0; seed < 40; ++seed) {
      CAPTURE(seed);
      const auto out = oriented(test::stirred(shape.mesh, seed / 39.0, seed));
      CHECK(test::sameMesh(out.mesh, expected.mesh));
    }
    CHECK(oriented(test::insideOut(shape.mesh)).report.flippedFaces == shape.mesh.faceCount());
  }
}

TEST_CASE("an open mesh follows the majority of its faces", "[orient][property]") {
  const PolygonMesh sheet = test::sheet(5, 4);
  const auto expected = oriented(sheet);
  const auto opposite = oriented(test::insideOut(sheet));
  for (std::uint32_t seed = 0; seed < 60; ++seed) {
    CAPTURE(seed);
    PolygonMesh mesh = sheet;
    std::vector<Index> faces(mesh.faceCount());
    std::iota(faces.begin(), faces.end(), 0);
    std::shuffle(faces.begin(), faces.end(), std::mt19937(seed));
    const Index flips = seed % 21;
    for (Index k = 0; k < flips; ++k) test::flipFace(mesh, faces[k]);
    const auto out = oriented(test::stirred(mesh, 0, seed));
    const bool firstKept =
        std::find(faces.begin(), faces.begin() + flips, 0) == faces.begin() + flips;
    const bool keeps = flips < 10 || (flips == 10 && firstKept);
    CHECK(test::sameMesh(out.mesh, keeps ? expected.mesh : opposite.mesh));
    CHECK(out.report.flippedFaces == (keeps ? flips : 20 - flips));
    CHECK(out.report.openComponents == 1);
  }
}

TEST_CASE("repair and orient together ignore winding and rotation of a crowded mesh",
          "[orient][property]") {
  PolygonMesh mesh = test::together(test::cube(), test::cube(), {2, 2, 0});  // a common edge
  mesh = test::together(mesh, test::cube(), {-2, 0, 0});                     // a common wall
  const auto prepare = [](const PolygonMesh& input) {
    RepairReport repairs;
    return oriented(repair(input, {}, repairs)).mesh;
  };
  const PolygonMesh expected = prepare(mesh);
  checkSound(expected);
  for (std::uint32_t seed = 0; seed < 40; ++seed) {
    // The wall is a component of its own, one face: it keeps its winding. Flip the others.
    PolygonMesh input = test::stirred(mesh, 0.5, seed);
    const PolygonMesh out = prepare(input);
    CHECK(out.points == expected.points);
    CHECK(out.faceOffsets == expected.faceOffsets);
    Index different = 0;
    for (Index f = 0; f < out.faceCount(); ++f)
      different += !std::ranges::equal(out.face(f), expected.face(f));
    CHECK(different <= 1);
  }
}

TEST_CASE("a cavity keeps facing inward if it does so in the input", "[orient]") {
  const PolygonMesh solid = test::cube();
  const PolygonMesh hollow =
      test::together(solid, test::insideOut(test::cube()), {0.1, 0.2, 0.1}, 0.5);
  const auto kept = oriented(hollow);
  CHECK(volume(kept.mesh) == Approx(7));
  CHECK(kept.report.cavities == 1);
  CHECK(kept.report.flippedFaces == 0);
  CHECK(test::sameMesh(kept.mesh, oriented(kept.mesh).mesh));

  CHECK(volume(oriented(test::together(solid, solid, {0.1, 0.2, 0.1}, 0.5)).mesh) == Approx(9));

  PolygonMesh inconsistent = hollow;
  test::flipFace(inconsistent, 7);
  const auto turned = oriented(inconsistent);
  CHECK(volume(turned.mesh) == Approx(9));
  CHECK(turned.report.cavities == 0);
}

TEST_CASE("an inside-out cube beside another one is no cavity", "[orient]") {
  const auto out = oriented(test::together(test::cube(), test::insideOut(test::cube()), {5, 0, 0}));
  CHECK(volume(out.mesh) == Approx(16));
  // The cube is inside the bounding box, but not inside: it is in the hole of the torus.
  const PolygonMesh ring =
      test::together(test::torusGrid(24, 12), test::insideOut(test::cube()), {0, 0, 0}, 0.1);
  CHECK(oriented(ring).report.cavities == 0);
  const PolygonMesh inTube =
      test::together(test::torusGrid(24, 12), test::insideOut(test::cube()), {1, 0, 0}, 0.1);
  CHECK(oriented(inTube).report.cavities == 1);
}

TEST_CASE("a Moebius strip becomes its double cover", "[orient]") {
  const int quads = GENERATE(5, 12);
  const auto out = oriented(test::moebius(quads));
  const auto n = static_cast<Index>(quads);
  CHECK(out.report.oneSided == std::vector<Index>{0});
  CHECK(out.report.components == 1);
  CHECK(out.report.openComponents == 0);
  CHECK(out.report.secondSide == n);
  CHECK(out.mesh.faceCount() == 2 * n);
  CHECK(out.mesh.pointCount() == 4 * n);
  CHECK(test::eulerCharacteristic(out.mesh) == 0);
  CHECK_THAT(summary(out.report), Contains("doubled 1 one-sided component (face 0)"));
  checkSound(out.mesh);
  CHECK(boundaryLoops(out.mesh, buildAdjacency(out.mesh)).size() == 2);  // an annulus
  for (Index v = 0; v < out.mesh.pointCount(); ++v)
    CHECK(out.mesh.points[v] == test::moebius(quads).points[out.report.pointOrigin[v]]);
  const auto again = oriented(out.mesh);
  CHECK(test::sameMesh(again.mesh, out.mesh));
  CHECK(again.report.oneSided.empty());
}

TEST_CASE("a Klein bottle becomes a torus over it", "[orient]") {
  const PolygonMesh bottle = test::klein(8, 5);
  const auto out = oriented(bottle);
  CHECK(out.report.oneSided.size() == 1);
  CHECK(out.mesh.faceCount() == 2 * bottle.faceCount());
  CHECK(out.mesh.pointCount() == 2 * bottle.pointCount());
  CHECK(test::eulerCharacteristic(out.mesh) == 0);
  CHECK(boundaryLoops(out.mesh, buildAdjacency(out.mesh)).empty());
  checkSound(out.mesh);
}

TEST_CASE("the two sides of a one-sided surface subdivide to the same points", "[orient]") {
  const PolygonMesh bottle = test::klein(6, 5);
  const auto out = oriented(bottle);
  const auto level = subdivide(baseLevel(out.mesh), 2);
  auto points = level.mesh.points;
  std::sort(points.begin(), points.end(), [](const Vec3d& p, const Vec3d& q) {
    return std::lexicographical_compare(p.begin(), p.end(), q.begin(), q.end());
  });
  // Every point of the limit is there twice, from both sides: sorted, they come in pairs.
  const auto pairs = points.size() / 2;
  std::vector<Vec3d> odd;
  std::vector<Vec3d> even;
  for (std::size_t k = 0; k < pairs; ++k) {
    even.push_back(points[2 * k]);
    odd.push_back(points[2 * k + 1]);
  }
  CHECK(test::samePoints(even, odd, 1e-12));
}

TEST_CASE("winding and rotation change only the side of one-sided surfaces", "[orient]") {
  const PolygonMesh strip = test::moebius(9);
  const auto expected = oriented(strip);
  for (std::uint32_t seed = 0; seed < 20; ++seed) {
    const auto out = oriented(test::stirred(strip, 0.5, seed));
    CHECK(out.mesh.faceCount() == expected.mesh.faceCount());
    CHECK(out.mesh.points == expected.mesh.points);
    checkSound(out.mesh);
  }
}

TEST_CASE("an empty mesh stays empty", "[orient]") {
  const auto out = oriented(PolygonMesh{});
  CHECK(out.mesh.faceCount() == 0);
  CHECK(out.report.components == 0);
}

TEST_CASE("components are turned one by one", "[orient]") {
  PolygonMesh mesh = test::insideOut(test::cube());
  for (int i = 1; i < 6; ++i)
    mesh =
        test::together(mesh, i % 2 ? test::cube() : test::insideOut(test::cube()), {3.0 * i, 0, 0});
  mesh = test::together(mesh, test::sheet(2, 2), {0, 9, 0});
  const auto out = oriented(mesh);
  CHECK(out.report.components == 7);
  CHECK(out.report.closedComponents == 6);
  CHECK(out.report.openComponents == 1);
  CHECK(out.report.flippedFaces == 18);
  CHECK(summary(out.report) == "flipped 18 faces");
}
