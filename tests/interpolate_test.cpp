#include "libvox/prepare/interpolate.h"

#include "libvox/core/error.h"
#include "libvox/core/parallel.h"
#include "libvox/io/scene_file.h"
#include "libvox/mesh/vertex_kind.h"
#include "libvox/prepare/boundary.h"
#include "libvox/prepare/lift.h"
#include "libvox/subdivide/doo_sabin.h"
#include "tests/shapes.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>

using namespace vox;
using Catch::Contains;

namespace {

constexpr int kMostIterations = 40;

/// Largest distance between interior vertices to interpolate and their limit points, the centroids
/// of the V-faces of level 1. Computed from the level, not from the lifting matrix.
double distanceFromInterior(const SubdivisionLevel& controls, const PolygonMesh& wanted,
                            const std::vector<Index>& vertices) {
  const SubdivisionLevel level = subdivide(controls, 1);
  std::vector<bool> asked(wanted.pointCount(), false);
  for (const Index v : vertices) asked[v] = true;
  double worst = 0;
  std::size_t found = 0;
  for (Index f = 0; f < level.mesh.faceCount(); ++f) {
    const auto face = level.mesh.face(f);
    const bool images = std::all_of(
        face.begin(), face.end(), [&](Index point) { return point < controls.mesh.cornerCount(); });
    if (!images) continue;  // a half face
    const Index v = controls.mesh.faceVertices[face[0]];
    const bool vertexFace = std::all_of(face.begin(), face.end(), [&](Index point) {
      return controls.mesh.faceVertices[point] == v;
    });
    if (!vertexFace || !asked[v]) continue;
    ++found;
    worst = std::max(worst, (test::faceCentroid(level.mesh, f) - wanted.points[v]).norm());
  }
  CHECK(found == vertices.size());
  return worst;
}

/// The same for boundary vertices: the limit points are the midpoints of the boundary edges in
/// their half V-faces.
double distanceFromBoundary(const SubdivisionLevel& controls, const PolygonMesh& wanted) {
  const SubdivisionLevel level = subdivide(controls, 3);
  std::vector<Vec3d> middles;
  for (Index c = 0; c < level.mesh.cornerCount(); ++c)
    if (level.adjacency.twin[c] == kNone)
      middles.push_back(
          0.5 *
          (level.mesh.points[level.mesh.faceVertices[c]] +
           level.mesh.points[level.mesh.faceVertices[nextCorner(level.mesh, level.adjacency, c)]]));
  double worst = 0;
  for (Index c = 0; c < controls.mesh.cornerCount(); ++c) {
    if (controls.adjacency.twin[c] != kNone) continue;
    double nearest = 1e300;
    for (const Vec3d& p : middles)
      nearest = std::min(nearest, (p - wanted.points[controls.mesh.faceVertices[c]]).norm());
    worst = std::max(worst, nearest);
  }
  return worst;
}

std::vector<Index> interiorOf(const SubdivisionLevel& level) {
  const auto kinds = vertexKinds(level.mesh, level.adjacency);
  std::vector<Index> vertices;
  for (Index v = 0; v < level.mesh.pointCount(); ++v)
    if (kinds[v] == VertexKind::kInterior) vertices.push_back(v);
  return vertices;
}

std::vector<test::Shape> allShapes() {
  std::vector<test::Shape> all = test::shapes();
  all.insert(all.end(), test::openShapes().begin(), test::openShapes().end());
  all.push_back({"apex of 300", test::pyramid(300), true});
  all.push_back({"jack", readScene(VOX_SCENES "/toy_jack.toml").objects[0].mesh, true});
  all.push_back({"wide sheet", test::shuffled(test::sheet(30, 20), 1), false});
  return all;
}

/// Largest distance of boundary vertices from the boundary curves, the quadratic B-splines of the
/// loops.
double distanceOfCurve(const SubdivisionLevel& controls, const PolygonMesh& wanted) {
  double worst = 0;
  for (const auto& loop : boundaryLoops(controls.mesh, controls.adjacency)) {
    const std::size_t n = loop.size();
    const auto vertex = [&](std::size_t i) { return controls.mesh.faceVertices[loop[i % n]]; };
    for (std::size_t i = 0; i < n; ++i) {
      const Vec3d there = 0.125 * controls.mesh.points[vertex(i + n - 1)] +
                          0.75 * controls.mesh.points[vertex(i)] +
                          0.125 * controls.mesh.points[vertex(i + 1)];
      worst = std::max(worst, (there - wanted.points[vertex(i)]).norm());
    }
  }
  return worst;
}

/// Moves every vertex a little at random and cuts a third of the faces in two.
PolygonMesh roughened(const PolygonMesh& mesh, double size) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> move(-size, size);
  PolygonMesh out;
  for (const Vec3d& p : mesh.points)
    out.points.push_back(p + Vec3d(move(random), move(random), move(random)));
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    const auto face = mesh.face(f);
    if (random() % 3 != 0) {
      out.addFace(face);
      continue;
    }
    out.addFace(face.first(3));
    out.addFace(std::vector<Index>{face[2], face[3], face[0]});
  }
  return out;
}

}  // namespace

TEST_CASE("the surface passes through the chosen vertices, in every combination",
          "[prepare][property]") {
  for (const auto& shape : allShapes())
    for (const Interpolate which : {Interpolate::kNothing, Interpolate::kInterior,
                                    Interpolate::kBoundary, Interpolate::kBoth}) {
      CAPTURE(shape.name, nameIn(kInterpolateNames, which));
      SubdivisionLevel level = baseLevel(shape.mesh);
      InterpolationReport report;
      level.mesh = interpolate(level.mesh, level.adjacency, which, {}, report);
      CHECK(report.lift.iterations <= kMostIterations);
      CHECK(level.mesh.faceVertices == shape.mesh.faceVertices);
      const bool both = which == Interpolate::kBoth;
      if (which == Interpolate::kNothing) CHECK(level.mesh.points == shape.mesh.points);
      if (both || which == Interpolate::kInterior) {
        const auto vertices = interiorOf(level);
        CHECK(report.lift.vertices == vertices.size());
        CHECK(report.lift.residual < 1e-11);
        CHECK(distanceFromInterior(level, shape.mesh, vertices) < 1e-11);
      }
      if (both || which == Interpolate::kBoundary)
        CHECK(distanceFromBoundary(level, shape.mesh) < 1e-13 * 20);
    }
}

TEST_CASE("only the prescribed vertices move", "[prepare]") {
  SubdivisionLevel level = baseLevel(test::torusGrid(12, 9));
  const PolygonMesh before = level.mesh;
  const std::vector<Index> some = {40, 3, 4, 77, 3};
  InterpolationReport report;
  level.mesh = interpolate(level.mesh, level.adjacency, Interpolate::kNothing, some, report);
  CHECK(report.lift.vertices == 4);
  CHECK(distanceFromInterior(level, before, {3, 4, 40, 77}) < 1e-12);
  for (Index v = 0; v < before.pointCount(); ++v)
    if (std::find(some.begin(), some.end(), v) == some.end())
      CHECK(level.mesh.points[v] == before.points[v]);
}

TEST_CASE("lifting moves with the model", "[prepare][property]") {
  const PolygonMesh mesh = test::dodecahedron();
  PolygonMesh far = mesh;
  for (Vec3d& p : far.points) p = 50.0 * p + Vec3d(1e4, -2e4, 3e4);
  const SubdivisionLevel level = baseLevel(mesh);
  InterpolationReport report;
  const auto near = interpolate(mesh, level.adjacency, Interpolate::kInterior, {}, report);
  const auto moved = interpolate(far, level.adjacency, Interpolate::kInterior, {}, report);
  for (Index v = 0; v < mesh.pointCount(); ++v)
    CHECK((moved.points[v] - (50.0 * near.points[v] + Vec3d(1e4, -2e4, 3e4))).norm() < 1e-9);
}

TEST_CASE("an interpolating closed curve passes through its points, few or many",
          "[prepare][property]") {
  for (const std::size_t n : {1, 2, 3, 4, 5, 17, 200, 5000}) {
    CAPTURE(n);
    std::vector<Vec3d> points;
    for (std::size_t i = 0; i < n; ++i)
      points.emplace_back(std::sin(static_cast<double>(3 * i * i)),
                          1e3 + static_cast<double>(i % 7), i % 2);
    const auto controls = interpolatingControls(points);
    double worst = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const Vec3d there =
          0.125 * controls[(i + n - 1) % n] + 0.75 * controls[i] + 0.125 * controls[(i + 1) % n];
      worst = std::max(worst, (there - points[i]).norm());
    }
    CHECK(worst < 1e-12);  // rounding of numbers of size 1000
  }
}

TEST_CASE("vertices that cannot be interpolated are refused by number", "[prepare][error]") {
  const auto refuse = [](const PolygonMesh& mesh, Interpolate which, Index v,
                         const std::string& reason) {
    const SubdivisionLevel level = baseLevel(mesh);
    InterpolationReport report;
    const std::array<Index, 1> list = {v};
    CHECK_THROWS_WITH(interpolate(mesh, level.adjacency, which, list, report),
                      Contains("vertex " + std::to_string(v)) && Contains(reason));
  };
  refuse(test::sheet(3, 3), Interpolate::kNothing, 0, "on the boundary");
  refuse(test::sheet(3, 3), Interpolate::kInterior, 2, "on the boundary");
  refuse(test::cube(), Interpolate::kBoth, 8, "only 8");
  refuse(test::bowTie(), Interpolate::kNothing, 0, "several fans");
  refuse(test::valenceTwo(), Interpolate::kInterior, 8, "two faces");
  PolygonMesh unused = test::cube();
  unused.points.emplace_back(5, 5, 5);
  refuse(unused, Interpolate::kNothing, 8, "no face");

  const PolygonMesh touching = test::meshOf(
      {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0}, {-1, -1, 0}}, {{0, 1, 2}, {0, 3, 4}});
  CHECK_THROWS_WITH(interpolateBoundary(touching, buildAdjacency(touching)), Contains("vertex 0"));
}

TEST_CASE("a prescribed boundary vertex needs boundary interpolation", "[prepare]") {
  const SubdivisionLevel level = baseLevel(test::sheet(3, 3));
  InterpolationReport report;
  const std::vector<Index> list = {0, 5};
  interpolate(level.mesh, level.adjacency, Interpolate::kBoundary, list, report);
  CHECK(report.boundaryVertices == 12);
  CHECK(report.lift.vertices == 1);
}

TEST_CASE("interpolating all interior vertices leaves out those without a V-face", "[prepare]") {
  for (const auto& mesh : {test::valenceTwo(), test::bowTie()}) {
    const SubdivisionLevel level = baseLevel(mesh);
    InterpolationReport report;
    interpolate(mesh, level.adjacency, Interpolate::kInterior, {}, report);
    CHECK(report.lift.vertices == mesh.pointCount() - 1);
  }
}

TEST_CASE("lifting does not depend on the number of threads", "[prepare][parallel]") {
  const PolygonMesh mesh = test::shuffled(test::sheet(150, 120), 2);
  const Adjacency adjacency = buildAdjacency(mesh);
  InterpolationReport report;
  const auto run = [&] { return interpolate(mesh, adjacency, Interpolate::kBoth, {}, report); };
  CHECK(onThreads(1, run).points == onThreads(8, run).points);
}

TEST_CASE("a face of 5000 corners and an apex of 5000 faces are lifted", "[prepare][property]") {
  SubdivisionLevel level = baseLevel(test::pyramid(5000));
  const PolygonMesh wanted = level.mesh;
  InterpolationReport report;
  level.mesh = interpolate(level.mesh, level.adjacency, Interpolate::kInterior, {}, report);
  CHECK(report.lift.iterations <= kMostIterations);
  CHECK(distanceFromInterior(level, wanted, interiorOf(level)) < 1e-10);
}

TEST_CASE("300,000 vertices need no more steps than a cube, closed or open",
          "[prepare][property]") {
  for (const auto& mesh :
       {roughened(test::torusGrid(1000, 300), 3e-4), roughened(test::sheet(600, 500), 0.1)}) {
    const double size = (mesh.points[mesh.pointCount() / 2] - mesh.points[0]).norm();
    SubdivisionLevel level = baseLevel(mesh);
    InterpolationReport report;
    level.mesh = interpolate(mesh, level.adjacency, Interpolate::kBoth, {}, report);
    CHECK(report.lift.iterations <= kMostIterations);
    CHECK(distanceFromInterior(level, mesh, interiorOf(level)) < 1e-12 * size);
    CHECK(distanceOfCurve(level, mesh) < 1e-12 * size);
  }
}

TEST_CASE("models of any size are lifted", "[prepare][property]") {
  for (const double size : {1e-200, 1e-9, 1e15, 1e200}) {
    CAPTURE(size);
    PolygonMesh mesh = test::dodecahedron();
    for (Vec3d& p : mesh.points) p *= size;
    SubdivisionLevel level = baseLevel(mesh);
    InterpolationReport report;
    level.mesh = interpolate(mesh, level.adjacency, Interpolate::kInterior, {}, report);
    CHECK(report.lift.iterations <= kMostIterations);
    for (Vec3d& p : level.mesh.points) p /= size;
    CHECK(distanceFromInterior(level, test::dodecahedron(), interiorOf(level)) < 1e-14 * 10);
  }
  PolygonMesh vast = test::cube();
  for (Vec3d& p : vast.points) p *= 1e308;
  InterpolationReport report;
  CHECK_THROWS_AS(interpolate(vast, buildAdjacency(vast), Interpolate::kInterior, {}, report),
                  LimitError);
}
