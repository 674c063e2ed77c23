#include "libvox/subdivide/doo_sabin.h"

#include "libvox/core/error.h"
#include "libvox/core/parallel.h"
#include "libvox/mesh/validate.h"
#include "libvox/subdivide/next_faces.h"
#include "tests/reference.h"
#include "tests/shapes.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

using namespace vox;

namespace {

std::int64_t edgeCount(const SubdivisionLevel& level) {
  std::int64_t edges = 0;
  for (Index c = 0; c < level.mesh.cornerCount(); ++c)
    edges += level.adjacency.twin[c] == kNone || leadsEdge(level.adjacency, c);
  return edges;
}

std::int64_t eulerCharacteristic(const SubdivisionLevel& level) {
  return std::int64_t{level.mesh.pointCount()} - edgeCount(level) + level.mesh.faceCount();
}

PolygonMesh moved(PolygonMesh mesh, const Eigen::Affine3d& transform) {
  for (Vec3d& p : mesh.points) p = transform * p;
  return mesh;
}

std::vector<std::vector<Index>> sortedFaces(const PolygonMesh& mesh) {
  std::vector<std::vector<Index>> faces;
  for (Index f = 0; f < mesh.faceCount(); ++f)
    faces.emplace_back(mesh.face(f).begin(), mesh.face(f).end());
  std::sort(faces.begin(), faces.end());
  return faces;
}

/// Value of the uniform quadratic B-spline basis functions that act on a span, at t in [0, 1].
Eigen::Vector3d quadraticBasis(double t) {
  return {0.5 * (1 - t) * (1 - t), 0.5 + t * (1 - t), 0.5 * t * t};
}

/// Level 0 of plain Doo-Sabin, which leaves boundaries free.
SubdivisionLevel freeLevel(const PolygonMesh& mesh) {
  return baseLevel(mesh, BoundaryRule::kFree);
}

}  // namespace

TEST_CASE("quad weights are 9/16, 3/16, 1/16, 3/16", "[subdivide][golden]") {
  PolygonMesh quad = test::regularPolygon(4);
  for (Vec3d& p : quad.points) p.setZero();
  quad.points[0].x() = 1;  // the weights of corner 0
  const auto image = imageVertices(freeLevel(quad));
  CHECK(image[0].x() == 9.0 / 16);
  CHECK(image[1].x() == 3.0 / 16);
  CHECK(image[2].x() == 1.0 / 16);
  CHECK(image[3].x() == 3.0 / 16);
}

TEST_CASE("weights of a face are those of the paper and sum to one", "[subdivide][property]") {
  for (int n = 3; n < 40; ++n) {
    CAPTURE(n);
    PolygonMesh polygon = test::regularPolygon(n);
    for (Vec3d& p : polygon.points) p = Vec3d(0, 1, 0);
    polygon.points[0].x() = 1;
    const auto image = imageVertices(freeLevel(polygon));
    for (int i = 0; i < n; ++i) {
      const double cosine = std::cos(2 * std::numbers::pi * i / n);
      const double weight = i == 0 ? (n + 5) / (4.0 * n) : (3 + 2 * cosine) / (4.0 * n);
      CHECK(image[static_cast<std::size_t>(i)].x() == Approx(weight).margin(1e-15));
      CHECK(image[static_cast<std::size_t>(i)].y() == Approx(1).margin(1e-15));
    }
  }
}

TEST_CASE("a cube makes 24, 96 and 384 vertices", "[subdivide][golden]") {
  SubdivisionLevel level = baseLevel(test::cube());
  for (const Index expected : {24U, 96U, 384U}) {
    level = subdivide(std::move(level), 1);
    CHECK(level.mesh.pointCount() == expected);
    CHECK(level.mesh.faceCount() == expected + 2);  // f = v + chi
    CHECK(edgeCount(level) == 2 * expected);
  }
}

TEST_CASE("the first image vertices of a unit square are its points pulled in by a quarter",
          "[subdivide][golden]") {
  const PolygonMesh square =
      test::meshOf({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2, 3}});
  const auto image = imageVertices(freeLevel(square));
  CHECK(image[0] == Vec3d(0.25, 0.25, 0));
  CHECK(image[2] == Vec3d(0.75, 0.75, 0));
}

TEST_CASE("every level is an oriented manifold of the same Euler characteristic",
          "[subdivide][property]") {
  for (const auto& shape : test::shapes()) {
    CAPTURE(shape.name);
    SubdivisionLevel level = freeLevel(shape.mesh);
    // Subdivision parts the two tetrahedra that share a point of the bow tie.
    const auto expected = shape.name == "bow tie" ? 4 : eulerCharacteristic(level);
    for (int k = 1; k <= 3; ++k) {
      CAPTURE(k);
      level = subdivide(std::move(level), 1);
      CHECK(eulerCharacteristic(level) == expected);
      REQUIRE_NOTHROW(requireValidArrays(level.mesh));
      // The twins made by index arithmetic are the ones a search finds.
      const Adjacency searched = buildAdjacency(level.mesh);
      CHECK(level.adjacency.twin == searched.twin);
      CHECK(level.adjacency.cornerFace == searched.cornerFace);
      CHECK(findDefects(level.mesh, searched).empty());
    }
  }
}

TEST_CASE("each step equals the formula applied corner by corner", "[subdivide][property]") {
  for (const auto& shape : test::shapes()) {
    CAPTURE(shape.name);
    SubdivisionLevel level = freeLevel(shape.mesh);
    for (int k = 0; k < 2; ++k) {
      const PolygonMesh expected = test::naiveDooSabin(level.mesh);
      level = subdivide(std::move(level), 1);
      CHECK(level.mesh.faceOffsets == expected.faceOffsets);
      CHECK(level.mesh.faceVertices == expected.faceVertices);
      double worst = 0;
      REQUIRE(level.mesh.points.size() == expected.points.size());
      for (std::size_t i = 0; i < expected.points.size(); ++i)
        worst = std::max(worst, (level.mesh.points[i] - expected.points[i]).norm());
      CHECK(worst < 1e-15 * 8);  // a dozen roundings of numbers of size 2
    }
  }
}

TEST_CASE("the faces that corners lead are those of the next level", "[subdivide][property]") {
  for (const auto& shape : test::shapes())
    for (const BoundaryRule rule : {BoundaryRule::kExtend, BoundaryRule::kFree}) {
      CAPTURE(shape.name);
      SubdivisionLevel level = baseLevel(shape.mesh, rule);
      for (int k = 0; k < 2; ++k) {
        CAPTURE(k);
        PolygonMesh led;
        const NextFaces next(level);
        for (Index c = 0; c < level.mesh.cornerCount(); ++c) next.append(c, led);
        level = subdivide(std::move(level), 1);
        CHECK(sortedFaces(led) == sortedFaces(level.mesh));
      }
    }
}

TEST_CASE("the F-face of any face keeps its centroid", "[subdivide][property]") {
  for (const auto& shape : test::shapes()) {
    CAPTURE(shape.name);
    SubdivisionLevel level = freeLevel(shape.mesh);
    for (int k = 0; k < 3; ++k) {
      const SubdivisionLevel child = subdivide(level, 1);
      double worst = 0;
      for (Index f = 0; f < level.mesh.faceCount(); ++f)
        worst = std::max(
            worst, (test::faceCentroid(level.mesh, f) - test::faceCentroid(child.mesh, f)).norm());
      CHECK(worst < 1e-14);
      level = child;
    }
  }
}

TEST_CASE("after one step every interior point has four faces", "[subdivide][property]") {
  for (const auto& shape : test::shapes()) {
    CAPTURE(shape.name);
    const SubdivisionLevel level = subdivide(baseLevel(shape.mesh), 1);
    for (Index c = 0; c < level.mesh.cornerCount(); ++c) {
      const OneRing ring = oneRing(level.mesh, level.adjacency, c);
      // A point of valence 2 makes no V-face, so its two image vertices have three faces.
      const bool besideValenceTwo = shape.name == "point of valence 2" && ring.corners.size() == 3;
      if (ring.closed && !besideValenceTwo) CHECK(ring.corners.size() == 4);
    }
  }
}

TEST_CASE("subdivision commutes with similarity transforms", "[subdivide][property]") {
  const Eigen::Affine3d transform = Eigen::Translation3d(3, -7, 2) *
                                    Eigen::AngleAxisd(0.7, Vec3d(1, 2, -1).normalized()) *
                                    Eigen::Scaling(2.5);
  for (const auto& shape : test::shapes()) {
    CAPTURE(shape.name);
    const auto before = subdivide(baseLevel(moved(shape.mesh, transform)), 3);
    const auto after = moved(subdivide(baseLevel(shape.mesh), 3).mesh, transform);
    double worst = 0;
    for (Index v = 0; v < after.pointCount(); ++v)
      worst = std::max(worst, (before.mesh.points[v] - after.points[v]).norm());
    CHECK(worst < 1e-13);
  }
}

TEST_CASE("numbering points and faces differently gives the same surface",
          "[subdivide][property]") {
  for (const auto& shape : test::shapes()) {
    CAPTURE(shape.name);
    const auto plain = subdivide(baseLevel(shape.mesh), 2);
    const auto other = subdivide(baseLevel(test::shuffled(shape.mesh, 7)), 2);
    CHECK(plain.mesh.faceCount() == other.mesh.faceCount());
    CHECK(test::samePoints(plain.mesh.points, other.mesh.points, 1e-13));
  }
}

TEST_CASE("a regular grid tends to the tensor-product quadratic B-spline",
          "[subdivide][property]") {
  // Control points of one biquadratic patch, and a rim that plain Doo-Sabin loses.
  const int n = 5;
  const PolygonMesh grid = test::sheet(n - 1, n - 1);
  // On the uniform B-spline the level-k control points of the middle patch tend to the surface; the
  // centroid of a face of any level lies on it. Face (i, j) of the grid has its centroid at the
  // corner (i, j) of the patches, where the surface is the mean of its four points.
  const int levels = 4;
  const auto refined = subdivide(freeLevel(grid), levels);
  const int scale = 1 << levels;
  double worst = 0;
  int compared = 0;
  for (Index f = 0; f < refined.mesh.faceCount(); ++f) {
    const Vec3d onSurface = test::faceCentroid(refined.mesh, f);
    // x and y of the sheet are linear in its parameters, and so the parameters of a point: the
    // uniform quadratic B-spline reproduces linear functions.
    const double u = onSurface.x() - 0.5;
    const double v = onSurface.y() - 0.5;
    if (u < 0 || v < 0 || u > n - 2 || v > n - 2) continue;
    const int i = std::min(static_cast<int>(u), n - 3);
    const int j = std::min(static_cast<int>(v), n - 3);
    const auto bu = quadraticBasis(u - i);
    const auto bv = quadraticBasis(v - j);
    Vec3d expected = Vec3d::Zero();
    for (int b = 0; b < 3; ++b)
      for (int a = 0; a < 3; ++a)
        expected += bu[a] * bv[b] * grid.points[static_cast<std::size_t>((j + b) * n + i + a)];
    worst = std::max(worst, (onSurface - expected).norm());
    ++compared;
  }
  CHECK(compared > (n - 2) * (n - 2) * scale * scale / 2);
  CHECK(worst < 1e-14 * 10);
}

TEST_CASE("levels do not depend on the number of threads", "[subdivide][parallel]") {
  const auto mesh = test::shuffled(GENERATE(test::torusGrid(40, 30), test::sheet(120, 90)), 3);
  const auto run = [&] { return subdivide(baseLevel(mesh), 3); };
  const auto one = onThreads(1, run);
  const auto eight = onThreads(8, run);
  CHECK(one.mesh.points == eight.mesh.points);
  CHECK(one.mesh.faceVertices == eight.mesh.faceVertices);
  CHECK(one.mesh.faceOffsets == eight.mesh.faceOffsets);
  CHECK(one.adjacency.twin == eight.adjacency.twin);
}

TEST_CASE("a face of 5000 corners and an apex of 5000 faces take linear time",
          "[subdivide][property]") {
  const auto level = subdivide(baseLevel(test::pyramid(5000)), 2);
  CHECK(eulerCharacteristic(level) == 2);
  CHECK(level.mesh.pointCount() == 4 * 20000);  // e_0 = 10000, v_2 = 2 * 4 e_0
}

TEST_CASE("a mesh that is not an oriented manifold is refused", "[subdivide][error]") {
  CHECK_THROWS_AS(baseLevel(test::moebius(8)), MeshError);
  PolygonMesh digon = test::cube();
  digon.faceOffsets[1] = 2;
  CHECK_THROWS_AS(baseLevel(digon), MeshError);
}
