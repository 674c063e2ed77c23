#include "libvox/voxelize/vertex.h"

#include "libvox/subdivide/doo_sabin.h"
#include "tests/reference.h"
#include "tests/shapes.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <random>

using namespace vox;
using openvdb::Coord;

namespace {

/// A closed blob whose points lie on a lattice of 1/16 voxel, jittered at random, so that ties of
/// the rounding are common and its faces come close to a given span.
PolygonMesh roughBlob(std::uint32_t seed, double radius) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> jitter(-0.1, 0.1);
  std::uniform_real_distribution<double> shift(-0.5, 0.5);
  constexpr double kLattice = 16;
  PolygonMesh mesh = subdivide(baseLevel(test::dodecahedron()), 3).mesh;
  const Vec3d centre(shift(random), shift(random), shift(random));
  for (Vec3d& p : mesh.points) {
    p = radius * p.normalized() + centre + Vec3d(jitter(random), jitter(random), jitter(random));
    p = (p * kLattice).array().round() / kLattice;
  }
  return mesh;
}

test::Sides sidesOfMarked(const PolygonMesh& mesh) {
  openvdb::MaskGrid mask;
  markVertices(mesh.points, mask);
  return test::sidesOf(mesh, mask);
}

}  // namespace

TEST_CASE("a position belongs to the voxel nearest to it, halves up", "[voxelize][golden]") {
  CHECK(voxelOf({0.4, -0.4, 1.6}) == Coord(0, 0, 2));
  CHECK(voxelOf({0.5, -0.5, 1.5}) == Coord(1, 0, 2));
  CHECK(voxelOf({-1.5, -0.51, -2.49}) == Coord(-1, -1, -2));
}

TEST_CASE("no path of white voxels joins the sides of a mesh of faces up to one voxel",
          "[voxelize][property]") {
  std::size_t tried = 0;
  double largest = 0;
  for (std::uint32_t seed = 0; seed < 60; ++seed) {
    CAPTURE(seed);
    const PolygonMesh mesh = roughBlob(seed, 4.0 + 0.01 * seed);
    const double span = test::naiveLargestSpan(mesh);
    if (span > 1) continue;
    ++tried;
    largest = std::max(largest, span);
    const test::Sides sides = sidesOfMarked(mesh);
    REQUIRE(sides.inside > 0);
    REQUIRE(sides.outside > 0);
    REQUIRE(sides.leaks == 0);
  }
  CHECK(tried > 30);     // the test has something to check
  CHECK(largest > 0.9);  // close to the criterion
}

TEST_CASE("larger faces do leak", "[voxelize][property]") {
  std::size_t leaking = 0;
  for (std::uint32_t seed = 0; seed < 20; ++seed)
    leaking += sidesOfMarked(roughBlob(seed, 9)).leaks;
  CHECK(leaking > 0);
}

TEST_CASE("rounding keeps the corners of a face of span one within a unit cube",
          "[voxelize][property]") {
  // The heart of the guarantee: the rounded face then meets a step between voxel centres only at
  // black voxels. Exact in binary, ties included.
  std::mt19937 random(4);
  std::uniform_int_distribution<int> coordinate(-64, 64);
  std::uniform_int_distribution<int> step(-16, 16);
  for (int i = 0; i < 200000; ++i) {
    const double a = coordinate(random) / 16.0;
    const double b = a + step(random) / 16.0;
    const int apart = voxelOf({a, 0, 0}).x() - voxelOf({b, 0, 0}).x();
    if (std::abs(apart) > 1) FAIL(a << " and " << b << " round to " << apart << " voxels apart");
  }
}

TEST_CASE("marking does not depend on the number of threads", "[voxelize][parallel]") {
  std::mt19937 random(3);
  std::normal_distribution<double> coordinate(0, 60);
  std::vector<Vec3d> points;
  for (int i = 0; i < 200000; ++i)
    points.emplace_back(coordinate(random), coordinate(random), coordinate(random));
  const auto mark = [&] {
    openvdb::MaskGrid mask;
    markVertices(points, mask);
    return mask.treePtr();
  };
  const auto one = test::onThreads(1, mark);
  const auto eight = test::onThreads(8, mark);
  CHECK(one->hasSameTopology(*eight));
  for (const Vec3d& p : points) CHECK(one->isValueOn(voxelOf(p)));
}
