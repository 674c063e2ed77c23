#include "libvox/voxelize/vertex.h"

#include "libvox/core/parallel.h"
#include "libvox/subdivide/doo_sabin.h"
#include "tests/reference.h"
#include "tests/shapes.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
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

TEST_CASE(
    "a grid line that crosses a triangle of L-inf edges up to one voxel meets one of its voxels",
    "[voxelize][property]") {
  // The paper's lemma (section 5), for the L-inf norm, in integers of 1/16 voxel: exact, ties too.
  constexpr long kUnit = 16;
  std::mt19937 random(5);
  std::uniform_int_distribution<long> anywhere(-3 * kUnit, 3 * kUnit);
  std::uniform_int_distribution<long> step(-kUnit, kUnit);
  const auto roundHalfUp = [](long x) {
    const long shifted = x + kUnit / 2;
    return shifted / kUnit - (shifted % kUnit < 0);
  };
  std::size_t crossings = 0;
  for (int i = 0; i < 1000000; ++i) {
    // Two coordinates across the grid line; the third does not matter to the lemma.
    std::array<std::array<long, 2>, 3> t;
    for (auto& x : t[0]) x = anywhere(random);
    for (std::size_t k : {0U, 1U}) {
      t[1][k] = t[0][k] + step(random);
      t[2][k] = t[0][k] + step(random);
    }
    if (std::abs(t[1][0] - t[2][0]) > kUnit || std::abs(t[1][1] - t[2][1]) > kUnit) continue;
    const auto side = [&](const auto& a, const auto& b, long x, long y) {
      return (b[0] - a[0]) * (y - a[1]) - (b[1] - a[1]) * (x - a[0]);
    };
    for (long x = -4; x <= 4; ++x)
      for (long y = -4; y <= 4; ++y) {
        const long a = side(t[0], t[1], x * kUnit, y * kUnit);
        const long b = side(t[1], t[2], x * kUnit, y * kUnit);
        const long c = side(t[2], t[0], x * kUnit, y * kUnit);
        if (!((a > 0 && b > 0 && c > 0) || (a < 0 && b < 0 && c < 0))) continue;
        ++crossings;
        const bool met = std::any_of(t.begin(), t.end(), [&](const auto& p) {
          return roundHalfUp(p[0]) == x && roundHalfUp(p[1]) == y;
        });
        if (!met) FAIL("triangle " << i << " covers (" << x << ", " << y << ") unseen");
      }
  }
  CHECK(crossings > 50000);
}

TEST_CASE("the footprint counts the nodes that marking makes", "[voxelize]") {
  std::mt19937 random(6);
  std::normal_distribution<double> coordinate(0, 3000);
  std::vector<Vec3d> points;
  for (int i = 0; i < 20000; ++i)
    points.emplace_back(coordinate(random), coordinate(random), coordinate(random));
  const TreeFootprint footprint = footprintOf(points);
  openvdb::MaskGrid mask;
  markVertices(points, mask);
  const auto nodes = mask.tree().nodeCount();
  CHECK(footprint.leaves == nodes[0]);
  CHECK(footprint.lowerNodes == nodes[1]);
  CHECK(footprint.upperNodes == nodes[2]);
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
  const auto one = onThreads(1, mark);
  const auto eight = onThreads(8, mark);
  CHECK(one->hasSameTopology(*eight));
  for (const Vec3d& p : points) CHECK(one->isValueOn(voxelOf(p)));
}
