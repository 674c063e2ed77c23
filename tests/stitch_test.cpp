#include "libvox/prepare/stitch.h"

#include "libvox/mesh/adjacency.h"
#include "libvox/prepare/sound.h"
#include "tests/shapes.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>
#include <random>
#include <utility>

using namespace vox;
using Catch::Contains;

namespace {

struct Stitched {
  PolygonMesh mesh;
  SoundReport report;
  std::size_t stitched() const { return report.repair[RepairKind::kStitchedVertex].count; }
};

Stitched stitchedOf(const PolygonMesh& mesh, double weld = 0) {
  Stitched sound;
  RepairOptions options;
  options.weldTolerance = weld;
  sound.mesh = soundMesh(mesh, options, sound.report);
  return sound;
}

/// Checks that a damaged copy of a closed mesh becomes a closed mesh of the same topology.
void checkClosesAs(const PolygonMesh& closed, const PolygonMesh& damaged, double weld) {
  const Stitched sound = stitchedOf(damaged, weld);
  const Stitched original = stitchedOf(closed);
  CHECK(sound.report.orient.openComponents == 0);
  CHECK(sound.report.orient.closedComponents == original.report.orient.closedComponents);
  CHECK(test::eulerCharacteristic(sound.mesh) == test::eulerCharacteristic(original.mesh));
  CHECK(test::faultOf(sound.mesh) == "");
}

/// A random unit vector.
Vec3d direction(std::mt19937& random) {
  std::normal_distribution<double> in;
  return Vec3d(in(random), in(random), in(random)).normalized();
}

/// Splits edges of a mesh with new vertices that only one of their two faces has, or each face its
/// own. The vertices are up to `width` off the edges.
PolygonMesh withSplitEdges(const PolygonMesh& mesh, std::mt19937& random, double width = 0) {
  PolygonMesh split;
  split.points = mesh.points;
  std::vector<Index> face;
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    face.clear();
    const auto corners = mesh.face(f);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      face.push_back(corners[i]);
      if (random() % 3 != 0) continue;
      const Vec3d a = mesh.points[corners[i]];
      const Vec3d b = mesh.points[corners[(i + 1) % corners.size()]];
      // Odd numerators on one side and even ones on the other keep the vertices apart.
      const bool forward = corners[i] < corners[(i + 1) % corners.size()];
      for (int k = forward ? 1 : 2; k < 16; k += 2 * (1 + static_cast<int>(random() % 4))) {
        const double t = k / 16.0;
        face.push_back(split.pointCount());
        split.points.push_back(a + t * (b - a) + width * direction(random));
      }
    }
    split.addFace(face);
  }
  return split;
}

/// Cuts faces in two, from the middle of an edge to another one. The neighbours do not get the new
/// vertices.
PolygonMesh withCutFaces(const PolygonMesh& mesh, std::mt19937& random, double width = 0) {
  PolygonMesh cut;
  cut.points = mesh.points;
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    const auto corners = mesh.face(f);
    if (random() % 2 == 0) {
      cut.addFace(corners);
      continue;
    }
    const std::size_t n = corners.size();
    const std::size_t i = random() % n;
    const std::size_t j = (i + 1 + random() % (n - 1)) % n;
    const auto middle = [&](std::size_t k, double t) {
      const Vec3d a = mesh.points[corners[k]];
      const Vec3d b = mesh.points[corners[(k + 1) % n]];
      cut.points.push_back(a + t * (b - a) + width * direction(random));
      return cut.pointCount() - 1;
    };
    const Index v = middle(i, 0.3);
    const Index w = middle(j, 0.6);
    std::vector<Index> one = {v};
    for (std::size_t k = (i + 1) % n; k != (j + 1) % n; k = (k + 1) % n) one.push_back(corners[k]);
    one.push_back(w);
    std::vector<Index> other = {w};
    for (std::size_t k = (j + 1) % n; k != (i + 1) % n; k = (k + 1) % n)
      other.push_back(corners[k]);
    other.push_back(v);
    cut.addFace(one);
    cut.addFace(other);
  }
  return cut;
}

PolygonMesh roundedToFloats(PolygonMesh mesh) {
  for (Vec3d& p : mesh.points)
    for (double& x : p) x = static_cast<float>(x);
  return mesh;
}

std::vector<test::Shape> closedShapes() {
  return {{"cube", test::cube(), true},
          {"tetrahedron", test::tetrahedron(), true},
          {"pyramid", test::pyramid(7), true},
          {"prism", test::prism(9), true},
          {"dodecahedron", test::dodecahedron(), true},
          {"torus", test::torusGrid(12, 7), true}};
}

struct Place {
  double scale;
  Vec3d shift;
};
const std::vector<Place>& places() {
  static const std::vector<Place> all = {{1, Vec3d::Zero()},
                                         {1e-6, Vec3d::Zero()},
                                         {1e6, Vec3d(0.1, 0, -3e5)},
                                         {1, Vec3d(500000.25, 4649776.5, 32.1)},
                                         {1e-3, Vec3d(1, -1, 1e-9)}};
  return all;
}

/// A pipe with caps, of slivers as long as the pipe. The polygons of the caps have every other
/// vertex of the rims only; the others lie on their edges.
PolygonMesh sliverPipe(Index slivers) {
  PolygonMesh mesh;
  const Index around = slivers / 2;
  for (const double z : {0.0, 500.0})
    for (Index i = 0; i < around; ++i) {
      const auto on = [&](Index k) {
        const double angle = 2 * std::numbers::pi * (k % around) / around;
        return Vec3d(10 * std::cos(angle), 10 * std::sin(angle), z);
      };
      mesh.points.push_back(i % 2 == 0 ? on(i) : Vec3d((on(i - 1) + on(i + 1)) / 2));
    }
  for (Index i = 0; i < around; ++i) {
    const Index j = (i + 1) % around;
    mesh.addFace(std::vector<Index>{i, j, around + j});
    mesh.addFace(std::vector<Index>{i, around + j, around + i});
  }
  std::vector<Index> bottom, top;
  for (Index i = 0; i < around; i += 2) {
    top.push_back(around + i);
    bottom.push_back(around - 2 - i);
  }
  mesh.addFace(bottom);
  mesh.addFace(top);
  return mesh;
}

}  // namespace

TEST_CASE("a vertex on another face's edge enters the face", "[stitch]") {
  // A box of 2 x 1 x 1 with two front faces; bottom and top lack the two vertices between them.
  PolygonMesh box = test::meshOf({{0, 0, 0},
                                  {2, 0, 0},
                                  {2, 1, 0},
                                  {0, 1, 0},
                                  {0, 0, 1},
                                  {2, 0, 1},
                                  {2, 1, 1},
                                  {0, 1, 1},
                                  {1, 0, 0},
                                  {1, 0, 1}},
                                 {{0, 3, 2, 1},
                                  {4, 5, 6, 7},
                                  {0, 8, 9, 4},
                                  {8, 1, 5, 9},
                                  {1, 2, 6, 5},
                                  {2, 3, 7, 6},
                                  {3, 0, 4, 7}});
  const Stitched sound = stitchedOf(box);
  CHECK(sound.report.orient.closedComponents == 1);
  CHECK(sound.mesh.faceSize(0) == 5);
  CHECK(sound.mesh.faceSize(1) == 5);
  CHECK(summary(sound.report) == "stitched 2 T-junctions");
  CHECK(firstAction(sound.report) == "stitched vertex 8 into face 0, on whose edge (1, 0) it lies");
}

TEST_CASE("edges split on one side only do not open a closed mesh", "[stitch][property]") {
  std::mt19937 random(5);
  for (const test::Shape& shape : closedShapes())
    for (const Place& place : places()) {
      CAPTURE(shape.name, place.scale, place.shift.transpose());
      const PolygonMesh closed = test::moved(shape.mesh, place.shift, place.scale);
      const PolygonMesh split = withSplitEdges(closed, random);
      const PolygonMesh cut = withCutFaces(closed, random);
      checkClosesAs(closed, split, 0);
      checkClosesAs(closed, cut, 0);
      checkClosesAs(closed, withCutFaces(cut, random), 0);
      checkClosesAs(closed, test::shuffled(test::unwelded(split), 3), 0);
    }
}

TEST_CASE("T-junctions that floats have rounded close by themselves", "[stitch][property]") {
  std::mt19937 random(6);
  for (const test::Shape& shape : closedShapes())
    for (const double scale : {1.0, 1e-6, 1234.5}) {
      CAPTURE(shape.name, scale);
      const PolygonMesh closed = test::moved(shape.mesh, Vec3d(3, -1.1, 0.7) * scale, scale);
      checkClosesAs(closed, roundedToFloats(withSplitEdges(closed, random)), 0);
      checkClosesAs(closed, roundedToFloats(withCutFaces(closed, random)), 0);
    }
}

TEST_CASE("seams up to the tolerance close", "[stitch][property]") {
  std::mt19937 random(7);
  for (const test::Shape& shape : closedShapes())
    for (const Place& place : places())
      for (const double width : {1e-3, 1e-6, 1e-14}) {
        CAPTURE(shape.name, place.scale, place.shift.transpose(), width);
        const PolygonMesh closed = test::moved(shape.mesh, place.shift, place.scale);
        const double gap = std::max(width * place.scale, 1e-15 * place.shift.norm());
        // Every face gets vertices of its own, off their places; then some edges are split.
        PolygonMesh damaged = test::unwelded(closed);
        for (Vec3d& p : damaged.points) p += 0.2 * gap * direction(random);
        damaged = withSplitEdges(damaged, random, 0.2 * gap);
        checkClosesAs(closed, damaged, 2.5 * gap);
      }
}

TEST_CASE("a gap wider than the tolerance stays open, and closed meshes are left alone",
          "[stitch]") {
  std::mt19937 random(8);
  const PolygonMesh split = withSplitEdges(test::dodecahedron(), random, 1e-3);
  CHECK(stitchedOf(split, 1e-5).report.orient.openComponents > 0);
  CHECK(stitchedOf(split, 3e-3).report.orient.openComponents == 0);
  for (const test::Shape& shape : test::shapes()) {
    CAPTURE(shape.name);
    CHECK(stitchedOf(shape.mesh).stitched() == 0);
  }
}

TEST_CASE("a pipe of slivers whose rims are T-junctions is one closed component", "[stitch]") {
  const PolygonMesh pipe = sliverPipe(3200);
  const Stitched sound = stitchedOf(pipe);
  CHECK(sound.report.orient.components == 1);
  CHECK(sound.report.orient.closedComponents == 1);
  CHECK(sound.stitched() == 1600);
  PolygonMesh text = pipe;  // as a file with six decimals has it
  for (Vec3d& p : text.points) p = (p * 1e6).array().round() / 1e6;
  CHECK(stitchedOf(text).report.orient.openComponents == 1);
  CHECK(stitchedOf(text, 2e-6).report.orient.closedComponents == 1);
}

TEST_CASE("two polylines with different breaks on one line close in order", "[stitch]") {
  // Two rows of faces meet at y = 0: 7 faces above, 11 below, between common ends.
  PolygonMesh mesh;
  const auto row = [&](Index n, double y) {
    const Index first = mesh.pointCount();
    for (Index i = 0; i <= n; ++i) {
      mesh.points.emplace_back(77.0 * i / n, 0, 0);
      mesh.points.emplace_back(77.0 * i / n, y, 0);
    }
    for (Index i = 0; i < n; ++i) {
      const Index v = first + 2 * i;
      mesh.addFace(std::vector<Index>{v, v + 2, v + 3, v + 1});
    }
  };
  row(7, 1);
  row(11, -1);
  const Stitched sound = stitchedOf(mesh);
  CHECK(sound.stitched() == 6 + 10);
  CHECK(sound.report.orient.components == 1);
  CHECK(boundaryLoops(sound.mesh, buildAdjacency(sound.mesh)).size() == 1);
  CHECK(sound.mesh.cornerCount() == 4 * 18 + 16);
}

TEST_CASE("a vertex that joins no edges does not enter a face", "[stitch]") {
  // The tip of a triangle touches the edge of a square.
  const PolygonMesh mesh =
      test::meshOf({{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 2, 0}, {1, 0, 0}, {0, -1, 0}, {2, -1, 0}},
                   {{0, 1, 2, 3}, {4, 5, 6}});
  CHECK(stitchedOf(mesh).stitched() == 0);
  CHECK(stitchedOf(mesh, 1e-3).stitched() == 0);
}

TEST_CASE("edges that lie on each other in thousands end the search", "[stitch]") {
  PolygonMesh fan;  // triangles with the edges from 0 to 1, 2, 3, ... on one line
  fan.points.emplace_back(0, 0, 0);
  constexpr Index kTriangles = 3000;
  for (Index i = 0; i < kTriangles; ++i) {
    fan.points.emplace_back(i + 1, 0, 0);
    fan.points.emplace_back(i + 1, 1, i);
    fan.addFace(std::vector<Index>{0, 2 * i + 1, 2 * i + 2});
  }
  CHECK(stitchedOf(fan).stitched() == 0);
}
