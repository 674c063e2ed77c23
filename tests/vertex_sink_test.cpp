#include "libvox/voxelize/vertex_sink.h"

#include "libvox/core/parallel.h"
#include "libvox/grid/voxel.h"
#include "libvox/mesh/patch_parts.h"
#include "libvox/subdivide/doo_sabin.h"
#include "libvox/voxelize/tile.h"
#include "tests/reference.h"
#include "tests/shapes.h"

#include <catch2/catch.hpp>
#include <hwy/targets.h>

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

openvdb::MaskTree::Ptr treeOf(std::span<const Vec3d> points) {
  ActiveVoxels grid;
  VertexSink sink(grid);
  sink.points(points, 1);
  sink.flush();
  return grid.takeTree();
}

test::Sides sidesOfMarked(const PolygonMesh& mesh) {
  return test::sidesOf(mesh, openvdb::MaskGrid(treeOf(mesh.points)));
}

}  // namespace

TEST_CASE("a position belongs to the voxel nearest to it, halves up", "[voxelize][golden]") {
  CHECK(voxelOf({0.4, -0.4, 1.6}) == Coord(0, 0, 2));
  CHECK(voxelOf({0.5, -0.5, 1.5}) == Coord(1, 0, 2));
  CHECK(voxelOf({-1.5, -0.51, -2.49}) == Coord(-1, -1, -2));
}

TEST_CASE("no path of inactive voxels joins the sides of a mesh of faces up to one voxel",
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
  // The core of the guarantee: so the rounded face meets a step between voxel centres only at
  // active voxels. All numbers are exact, so ties are included.
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
  // The lemma of the paper (section 5) for the L-inf norm. Integers of 1/16 voxel: exact, with
  // ties.
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
    // Two coordinates, across the grid line; the lemma does not use the third.
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

namespace {

std::vector<Vec3d> scattered(std::size_t count, double spread, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> coordinate(0, spread);
  std::vector<Vec3d> points;
  for (std::size_t i = 0; i < count; ++i)
    points.emplace_back(coordinate(random), coordinate(random), coordinate(random));
  return points;
}

}  // namespace

TEST_CASE("the voxels of points are those that hold one", "[voxelize]") {
  // Points that are further apart take more memory each.
  for (const auto& [spread, count] : {std::pair(2.0, 20000), std::pair(60.0, 20000),
                                      std::pair(5000.0, 5000), std::pair(1e8, 200)}) {
    CAPTURE(spread);
    const std::vector<Vec3d> points = scattered(count, spread, 6);
    const auto tree = treeOf(points);
    openvdb::MaskTree expected;
    for (const Vec3d& p : points) expected.setValueOn(voxelOf(p));
    CHECK(tree->activeVoxelCount() == expected.activeVoxelCount());
    CHECK(tree->hasSameTopology(expected));
  }
}

TEST_CASE("sinks on several threads fill one grid as one sink does", "[voxelize][parallel]") {
  const std::vector<Vec3d> points = scattered(200000, 60, 3);
  ActiveVoxels grid;
  constexpr std::size_t kParts = 50;
  onThreads(8, [&] {
    parallelForEach(kParts, 1, [&](std::size_t part) {
      VertexSink sink(grid);
      const std::size_t size = points.size() / kParts;
      sink.points(std::span(points).subspan(part * size, size), 1);
      sink.flush();
    });
    return 0;
  });
  CHECK(grid.takeTree()->hasSameTopology(*treeOf(points)));
}

TEST_CASE("a grid that would outgrow its limit is refused", "[voxelize][error]") {
  ActiveVoxels grid(1 << 20);
  VertexSink sink(grid);
  CHECK_THROWS_AS(sink.points(scattered(20000, 5000, 1), 1), LimitError);
}

namespace {

Patch randomPatch(std::mt19937& random, double size, const Vec3d& at) {
  std::uniform_real_distribution<double> jitter(-0.5, 0.5);
  Patch patch;
  for (std::size_t u = 0; u < 3; ++u)
    for (std::size_t v = 0; v < 3; ++v)
      patch.points[u][v] =
          at + size * Vec3d(double(u) + jitter(random), double(v) + jitter(random), jitter(random));
  return patch;
}

/// All descendants in double precision, by the closed form.
std::vector<Vec3d> descendants(const Patch& patch, int k) {
  const std::int64_t n = std::int64_t{1} << k;
  const auto& p = patch.points;
  std::vector<Vec3d> vertices;
  for (std::int64_t i = 0; i < n; ++i)
    for (std::int64_t j = 0; j < n; ++j) {
      const PatchWeights u(i, n);
      const PatchWeights v(j, n);
      vertices.push_back(v(u(p[0][0], p[1][0], p[2][0]), u(p[0][1], p[1][1], p[2][1]),
                           u(p[0][2], p[1][2], p[2][2])));
    }
  return vertices;
}

/// Whether a position is within `distance` of a second voxel.
bool nearlyTied(const Vec3d& position, double distance) {
  for (const double x : position)
    if (std::abs(x + 0.5 - std::round(x + 0.5)) <= distance) return true;
  return false;
}

}  // namespace

TEST_CASE("a patch marks the voxels of its descendants, up to rounding ties",
          "[voxelize][property]") {
  std::mt19937 random(8);
  std::size_t ties = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const int k = trial % 9;
    const double size = std::ldexp(0.5, k) * (1 + trial % 3) / 3.0;
    const double far = trial % 2 == 0 ? 20.0 : 16384.0;
    const Patch patch = randomPatch(random, size, Vec3d(far, -far, 0.3 * far));
    ActiveVoxels grid;
    VertexSink sink(grid);
    sink.patch(patch, k, k);
    sink.flush();
    const auto tree = grid.takeTree();
    const std::vector<Vec3d> vertices = descendants(patch, k);
    CHECK(sink.vertices()[static_cast<std::size_t>(k)] == vertices.size());
    const auto expected = treeOf(vertices);
    // A voxel that differs must be near a vertex that is almost tied between two voxels.
    openvdb::MaskTree excusable;
    for (const Vec3d& p : vertices)
      if (nearlyTied(p, kTileError))
        for (const double dx : {-kTileError, kTileError})
          for (const double dy : {-kTileError, kTileError})
            for (const double dz : {-kTileError, kTileError})
              excusable.setValueOn(voxelOf(p + Vec3d(dx, dy, dz)));
    for (auto voxel = tree->cbeginValueOn(); voxel; ++voxel)
      if (!expected->isValueOn(voxel.getCoord())) {
        ++ties;
        REQUIRE(excusable.isValueOn(voxel.getCoord()));
      }
    for (auto voxel = expected->cbeginValueOn(); voxel; ++voxel)
      if (!tree->isValueOn(voxel.getCoord())) {
        ++ties;
        REQUIRE(excusable.isValueOn(voxel.getCoord()));
      }
  }
  CHECK(ties < 50);
}

TEST_CASE("a curve marks the voxels of its vertices, up to rounding ties", "[voxelize][property]") {
  std::mt19937 random(12);
  std::uniform_real_distribution<double> coordinate(-1, 1);
  constexpr double kRounding = 1e-11;
  std::size_t checked = 0;
  for (int trial = 0; trial < 200; ++trial) {
    const int k = trial % 10;
    const std::int64_t n = std::int64_t{1} << k;
    CurvePoints points;
    for (Vec3d& p : points) {
      p = {coordinate(random), coordinate(random), coordinate(random)};
      p = static_cast<double>(n) * p + (trial % 2 == 0 ? Vec3d(3, -4, 5) : Vec3d(16384, 0.5, -900));
    }
    ActiveVoxels grid;
    VertexSink sink(grid);
    sink.curve(points, k, k);
    sink.flush();
    CHECK(sink.vertices()[static_cast<std::size_t>(k)] == static_cast<std::uint64_t>(n));
    std::vector<Vec3d> vertices;
    for (std::int64_t j = 0; j < n; ++j)
      vertices.push_back(PatchWeights(j, n)(points[0], points[1], points[2]));
    if (std::any_of(vertices.begin(), vertices.end(),
                    [&](const Vec3d& p) { return nearlyTied(p, kRounding); }))
      continue;
    ++checked;
    CHECK(grid.takeTree()->hasSameTopology(*treeOf(vertices)));
  }
  CHECK(checked > 150);
}

TEST_CASE("the four children of a patch have its descendants", "[voxelize][property]") {
  std::mt19937 random(9);
  for (int trial = 0; trial < 20; ++trial) {
    const Patch patch = randomPatch(random, 3, Vec3d(1, 2, 3));
    std::vector<Vec3d> ofChildren;
    for (const auto& row : childrenOf(patch))
      for (const Patch& child : row)
        for (const Vec3d& p : descendants(child, 2)) ofChildren.push_back(p);
    CHECK(test::samePoints(ofChildren, descendants(patch, 3), 1e-13));
  }
}

TEST_CASE("every instruction set marks the same voxels", "[voxelize][simd]") {
  std::mt19937 random(10);
  std::vector<Patch> patches;
  for (int trial = 0; trial < 60; ++trial)
    patches.push_back(randomPatch(random, 6 + trial % 30, Vec3d(100, 200, -300)));
  const auto mark = [&] {
    ActiveVoxels grid;
    VertexSink sink(grid);
    for (const Patch& patch : patches) {
      sink.patch(patch, 3 + static_cast<int>(patch.points[1][1].x()) % 4, 1);
      sink.curve(patch.points[1], static_cast<int>(patch.points[1][1].x()) % 9, 1);
    }
    sink.flush();
    return grid.takeTree();
  };
  const auto best = mark();
  std::size_t tried = 0;
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    CAPTURE(hwy::TargetName(target));
    hwy::GetChosenTarget().Update(target);
    CHECK(mark()->hasSameTopology(*best));
    ++tried;
  }
  hwy::GetChosenTarget().DeInit();
  CHECK(tried >= 2);  // the plain one, and another
}
