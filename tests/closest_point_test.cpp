// The truth of the level sets, against closed facts.

#include "tests/closest_point.h"

#include "libvox/mesh/patch.h"
#include "libvox/subdivide/doo_sabin.h"
#include "libvox/subdivide/strip.h"
#include "tests/limit_pieces.h"
#include "tests/shapes.h"
#include "tests/spline_torus.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

using namespace vox;
using test::ClosestPoint;
using test::ClosestPolygon;

namespace {

/// Levels after which what is left around extraordinary faces does not matter.
constexpr int kDeep = 16;

std::vector<Vec3d> randomPoints(int count, double reach) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> at(-reach, reach);
  std::vector<Vec3d> points;
  for (int i = 0; i < count; ++i) {
    const double x = at(random);
    const double y = at(random);
    points.emplace_back(x, y, at(random));
  }
  return points;
}

/// Points of the limit surface, and a distance within which every other point has one.
struct LimitCloud {
  std::vector<Vec3d> points;
  double spacing = 0;
};
LimitCloud limitCloud(const SubdivisionLevel& fine) {
  LimitCloud cloud;
  for (Index f = 0; f < fine.mesh.faceCount(); ++f) {
    const auto face = fine.mesh.face(f);
    Vec3d middle = test::faceCentroid(fine.mesh, f);
    const Index edge = fine.boundary == BoundaryStage::kStrips ? boundaryCornerOf(fine, f) : kNone;
    if (edge != kNone) {
      const Index next = nextCorner(fine.mesh, fine.adjacency, edge);
      middle = (fine.mesh.points[fine.mesh.faceVertices[edge]] +
                fine.mesh.points[fine.mesh.faceVertices[next]]) /
               2;
    }
    cloud.points.push_back(middle);
    for (const Index v : face)
      cloud.spacing = std::max(cloud.spacing, 2 * (fine.mesh.points[v] - middle).norm());
  }
  return cloud;
}

double distanceToCloud(const LimitCloud& cloud, const Vec3d& p) {
  double least = std::numeric_limits<double>::infinity();
  for (const Vec3d& s : cloud.points) least = std::min(least, (s - p).squaredNorm());
  return std::sqrt(least);
}

/// @param samples  about how many limit points to compare with
void requireMinima(const SubdivisionLevel& base, Index samples) {
  int levels = 1;
  for (Index faces = base.mesh.cornerCount(); faces < samples; faces *= 4) ++levels;
  const SubdivisionLevel fine = subdivide(base, levels);
  const LimitCloud cloud = limitCloud(fine);
  const ClosestPoint truth(base, kDeep);
  const ClosestPolygon polygons(fine.mesh);
  double largest = 0;
  for (std::size_t i = 0; i < cloud.points.size(); i += 13)
    largest = std::max(largest, truth.of(cloud.points[i]).distance);
  CHECK(largest < 1e-6);
  double reach = 0;
  for (const Vec3d& p : base.mesh.points) reach = std::max(reach, p.norm());
  for (const Vec3d& p : randomPoints(40, 1.3 * reach)) {
    CAPTURE(p.transpose());
    const ClosestPoint::Foot foot = truth.of(p);
    const double sampled = distanceToCloud(cloud, p);
    CHECK(foot.distance <= sampled + 1e-4);  // chords of the last triangles: 2^-16 of a face
    CHECK(foot.distance >= sampled - cloud.spacing);
    CHECK(distanceToCloud(cloud, foot.point) <= cloud.spacing);
    CHECK((p - foot.point).norm() == Approx(foot.distance));
    const ClosestPolygon::Foot about = polygons.of(p);
    CHECK(about.distance == Approx(foot.distance).margin(cloud.spacing));
    if (std::min(foot.cosine, about.cosine) > 0.5 && foot.distance > cloud.spacing)
      CHECK((foot.signedDistance < 0) == (about.signedDistance < 0));
  }
}

PolygonMesh octahedron() {
  return test::meshOf(
      {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
      {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}});
}

/// A tube whose cross-section is a regular polygon, along z from 0 to `length`.
PolygonMesh straightTube(int sides, int along, double length) {
  PolygonMesh mesh = test::tube(sides, along);
  for (Index v = 0; v < mesh.pointCount(); ++v) {
    const double angle = 2 * std::numbers::pi * (v % static_cast<Index>(sides)) / sides;
    const double z = length * (v / static_cast<Index>(sides)) / along;
    mesh.points[v] = Vec3d(10 * std::cos(angle), 10 * std::sin(angle), z);
  }
  return mesh;
}

/// Distance in the plane z = 0 from the closed quadratic B-spline of a loop, by samples.
double distanceToSpline(const std::vector<Vec3d>& loop, const Vec3d& p) {
  constexpr int kSamples = 4000;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < loop.size(); ++i)
    for (int k = 0; k <= kSamples; ++k) {
      const SplinePlace place{double(k) / kSamples};
      const Vec3d s =
          place.value(loop[i], loop[(i + 1) % loop.size()], loop[(i + 2) % loop.size()]);
      least = std::min(least, (s - p).norm());
    }
  return least;
}

}  // namespace

TEST_CASE("closest points are global minima over the limit surface", "[truth][property]") {
  for (const auto& shape : test::shapes()) {
    CAPTURE(shape.name);
    requireMinima(baseLevel(test::scaled(shape.mesh, 5)), 10000);
  }
  for (const auto& shape : test::openShapes()) {
    CAPTURE(shape.name);
    requireMinima(baseLevel(test::scaled(shape.mesh, 5)), 1500);
  }
}

TEST_CASE("pieces meet: few levels and many agree", "[truth]") {
  for (const auto& shape : test::shapes()) {
    CAPTURE(shape.name);
    const SubdivisionLevel base = baseLevel(test::scaled(shape.mesh, 5));
    const ClosestPoint coarse(base, 9);
    const ClosestPoint fine(base, kDeep);
    for (const Vec3d& p : randomPoints(60, 7)) {
      const auto a = coarse.of(p);
      const auto b = fine.of(p);
      CHECK(a.distance == Approx(b.distance).margin(1e-3));
      if (b.cosine * b.distance > 0.01 && b.cosine > 0.99)
        CHECK((a.signedDistance < 0) == (b.signedDistance < 0));
    }
  }
}

TEST_CASE("triangles around extraordinary faces have their corners on the limit surface",
          "[truth][property]") {
  std::vector<test::Shape> shapes = test::shapes();
  shapes.insert(shapes.end(), test::openShapes().begin(), test::openShapes().end());
  for (const auto& shape : shapes) {
    CAPTURE(shape.name);
    const SubdivisionLevel base = baseLevel(test::scaled(shape.mesh, 5));
    const ClosestPoint truth(base, kDeep);
    double largest = 0;
    for (const auto& triangle : test::limitPieces(base, 3).triangles)
      for (const Vec3d& corner : triangle) largest = std::max(largest, truth.of(corner).distance);
    CHECK(largest < 1e-6);
  }
}

TEST_CASE("closest points are global minima over patches that are folded and twisted",
          "[truth][property]") {
  PolygonMesh mesh = test::torusGrid(4, 4);
  mesh.points = randomPoints(16, 5);
  const SubdivisionLevel base = baseLevel(mesh);
  const ClosestPoint truth(base, 2);
  const test::LimitPieces pieces = test::limitPieces(base, 2);
  REQUIRE(pieces.patches.size() == 16);
  REQUIRE(pieces.triangles.empty());
  constexpr int kSamples = 40;
  std::vector<Vec3d> points;
  for (const Patch& patch : pieces.patches)
    for (int i = 0; i <= kSamples; ++i)
      for (int j = 0; j <= kSamples; ++j)
        points.push_back(
            splinePoint(patch.points, {double(i) / kSamples}, {double(j) / kSamples}).point);
  for (const Vec3d& p : randomPoints(2000, 5)) {
    const double sampled = distanceToCloud({points}, p);
    const ClosestPoint::Foot foot = truth.of(p);
    CHECK(foot.distance <= sampled + 1e-11);
    CHECK(foot.distance >= sampled - 0.3);
    CHECK(foot.cosine == Approx(1).margin(1e-9));
  }
}

TEST_CASE("the way from a saddle's axis to the saddle is not its shortest", "[truth][golden]") {
  // One patch: z = x y over [-1/2, 1/2]^2. From (0, 0, 9/8), the squared distance along x = y is
  // 2 x^2 + (x^2 - 9/8)^2, which is least at x^2 = 1/8.
  PolygonMesh mesh = test::sheet(2, 2);
  for (Vec3d& p : mesh.points) {
    p -= Vec3d(1, 1, p.z());
    p.z() = p.x() * p.y();
  }
  const ClosestPoint::Foot foot =
      ClosestPoint(baseLevel(mesh, BoundaryRule::kFree), 2).of({0, 0, 1.125});
  CHECK(foot.distance == Approx(std::sqrt(1.25)).margin(1e-12));
  CHECK(std::abs(foot.point.x()) == Approx(std::sqrt(0.125)).margin(1e-9));
}

TEST_CASE("distances and normals are those of a spline torus", "[truth][golden]") {
  const test::SplineTorus torus(12, 8);
  const ClosestPoint truth(baseLevel(test::torusGrid(12, 8)), 3);
  int count = 0;
  for (int i = 0; i < 200; ++i) {
    const double u = std::fmod(0.37 * i, 12);
    const double v = std::fmod(0.23 * i, 8);
    const Vec3d p = torus.at(u, v) + 0.2 * std::sin(i) * torus.normalAt(u, v);
    const ClosestPoint::Foot foot = truth.of(p);
    CHECK(foot.signedDistance == Approx(0.2 * std::sin(i)).margin(1e-10));
    CHECK((foot.point - torus.at(u, v)).norm() < 1e-9);
    CHECK((foot.normal - torus.normalAt(u, v)).norm() < 1e-9);
    CHECK(foot.cosine == Approx(1).margin(1e-9));
    ++count;
  }
  CHECK(count == 200);
}

TEST_CASE("normals are those of the patches", "[truth]") {
  for (const auto& mesh : {test::dodecahedron(), test::prism(5), test::sheet(5, 4)}) {
    const SubdivisionLevel base = baseLevel(test::scaled(mesh, 5));
    const test::LimitPieces pieces = test::limitPieces(base, 5);
    const ClosestPoint truth(base, 5);
    for (const Patch& patch : pieces.patches) {
      const auto [point, normal] = splinePoint(patch.points, {0.3}, {0.6});
      for (const double side : {-1e-3, 1e-3}) {
        const ClosestPoint::Foot foot = truth.of(point + side * normal);
        CHECK(foot.signedDistance == Approx(side).margin(1e-10));
        CHECK((foot.normal - normal).norm() < 1e-6);
      }
    }
  }
}

TEST_CASE("the middles of a cube's and an octahedron's faces are on the limit surface",
          "[truth][golden]") {
  const ClosestPoint cube(baseLevel(test::scaled(test::cube(), 5)), kDeep);
  const ClosestPoint octa(baseLevel(test::scaled(octahedron(), 5)), kDeep);
  const Vec3d x = Vec3d::UnitX();
  const Vec3d diagonal = Vec3d::Ones().normalized();
  for (const double t : {-0.7, -0.1, 0.1, 1.0, 20.0}) {
    CAPTURE(t);
    const ClosestPoint::Foot onCube = cube.of((5 + t) * x);
    CHECK(onCube.signedDistance == Approx(t).margin(1e-8));
    CHECK((onCube.normal - x).norm() < 1e-3);
    const ClosestPoint::Foot onOcta = octa.of((5 / std::sqrt(3) + t) * diagonal);
    CHECK(onOcta.signedDistance == Approx(t).margin(1e-8));
    CHECK((onOcta.normal - diagonal).norm() < 1e-3);
  }
  for (const Vec3d& p : randomPoints(50, 6)) {
    const double distance = octa.of(p).signedDistance;
    CHECK(octa.of({p.y(), p.z(), p.x()}).signedDistance == Approx(distance).margin(1e-6));
    CHECK(octa.of({-p.x(), p.y(), p.z()}).signedDistance == Approx(distance).margin(1e-6));
  }
}

TEST_CASE("an extended tube ends in the planes of its boundary loops", "[truth][boundary]") {
  const int sides = 16;
  const double apothem = 10 * std::cos(std::numbers::pi / sides);
  const double angle = std::numbers::pi / sides;  // the middle of a side, where the curve touches
  const Vec3d out(std::cos(angle), std::sin(angle), 0);
  const Vec3d z = Vec3d::UnitZ();
  const ClosestPoint truth(baseLevel(straightTube(sides, 5, 20)), 6);
  for (const double t : {-3.0, -0.5, 0.5, 4.0}) {
    for (const double height : {0.01, 5.0, 11.0, 19.9})
      CHECK(truth.of((apothem + t) * out + height * z).signedDistance == Approx(t).margin(1e-10));
    const ClosestPoint::Foot beyond = truth.of((apothem + t) * out + 23 * z);
    CHECK(beyond.distance == Approx(std::hypot(3, t)).margin(1e-10));
    CHECK(beyond.cosine == Approx(std::abs(t) / std::hypot(3, t)).margin(1e-10));
  }
  // A free boundary is half a face further in.
  const ClosestPoint free(baseLevel(straightTube(sides, 5, 20), BoundaryRule::kFree), 6);
  CHECK(free.of(apothem * out + 23 * z).distance == Approx(5).margin(1e-10));
}

TEST_CASE("a flat sheet ends in the spline of its boundary loop", "[truth][boundary]") {
  PolygonMesh mesh = test::scaled(test::sheet(5, 4), 4);
  for (Vec3d& p : mesh.points) p.z() = 0;
  const SubdivisionLevel base = baseLevel(mesh);
  std::vector<Vec3d> loop;
  const auto loops = boundaryLoops(base.mesh, base.adjacency);
  for (const Index c : loops.at(0)) loop.push_back(base.mesh.points[base.mesh.faceVertices[c]]);
  const ClosestPoint truth(base, kDeep);
  for (const Vec3d& p : randomPoints(60, 12)) {
    const Vec3d shifted = p + Vec3d(10, 8, 0);
    const Vec3d flat(shifted.x(), shifted.y(), 0);
    const ClosestPoint::Foot inPlane = truth.of(flat);
    const ClosestPoint::Foot above = truth.of(shifted);
    CHECK(above.distance == Approx(std::hypot(inPlane.distance, p.z())).margin(1e-8));
    CHECK((above.signedDistance < 0) == (p.z() < 0));
    if (inPlane.distance < 1e-6) continue;
    CHECK(inPlane.distance == Approx(distanceToSpline(loop, flat)).margin(1e-5));
    CHECK(above.cosine == Approx(std::abs(p.z()) / above.distance).margin(1e-6));
  }
}

TEST_CASE("distances from polygons are those of the solid that they enclose", "[truth][golden]") {
  const ClosestPolygon truth(test::scaled(test::cube(), 5));
  for (const Vec3d& p : randomPoints(2000, 12)) {
    const Vec3d beyond = p.cwiseAbs() - Vec3d::Constant(5);
    const double distance = beyond.cwiseMax(0).norm() + std::min(beyond.maxCoeff(), 0.0);
    const ClosestPolygon::Foot foot = truth.of(p);
    CHECK(foot.signedDistance == Approx(distance).margin(1e-12));
    CHECK(foot.cosine == 1);
  }
  // A needle: near its edges, faces see the same point from different sides.
  const PolygonMesh needle = test::meshOf({{10, 0, 0}, {0, 1, 0}, {0, -1, 1}, {0, -1, -2}},
                                          {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}});
  const ClosestPolygon sharp(needle);
  for (const Vec3d& p : randomPoints(2000, 12)) {
    double side = -1;
    for (Index f = 0; f < needle.faceCount(); ++f) {
      const auto face = needle.face(f);
      const Vec3d& a = needle.points[face[0]];
      side =
          std::max(side, (needle.points[face[1]] - a).cross(needle.points[face[2]] - a).dot(p - a));
    }
    CHECK((sharp.of(p).signedDistance > 0) == (side > 0));
  }
  // An open sheet: beside it, the way is not along the normal.
  const ClosestPolygon open(test::scaled(test::regularPolygon(4), 5));
  const ClosestPolygon::Foot beside = open.of({9, 0, -3});
  CHECK(beside.distance == Approx(5));
  CHECK(beside.signedDistance == Approx(-5));
  CHECK(beside.cosine == Approx(0.6));
}
