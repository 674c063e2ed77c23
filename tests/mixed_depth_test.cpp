// The guarantee of vertex conversion for neighbouring vertices of different levels, checked by
// brute force.

#include "libvox/grid/transform.h"
#include "libvox/grid/voxel.h"
#include "libvox/prepare/repair.h"
#include "libvox/subdivide/doo_sabin.h"
#include "libvox/subdivide/stop.h"
#include "tests/reference.h"
#include "tests/shapes.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <random>

using namespace vox;

namespace {

/// Largest L-inf diameter of the faces around each point.
std::vector<double> facesAround(const PolygonMesh& mesh) {
  std::vector<double> largest(mesh.pointCount(), 0.0);
  std::vector<Vec3d> corners;
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    corners.clear();
    for (const Index v : mesh.face(f)) corners.push_back(mesh.points[v]);
    const double size = diameter(corners);
    for (const Index v : mesh.face(f)) largest[v] = std::max(largest[v], size);
  }
  return largest;
}

/// The voxels of a closed surface whose vertices stop at random levels: no vertex stops before the
/// faces around it measure at most `span`; at the last level all stop.
struct RandomDepths {
  openvdb::MaskGrid mask;
  PolygonMesh fine;          ///< the first level with faces of at most one voxel
  int levels = 0;            ///< from the first vertex that stops to the last
  std::size_t vertices = 0;  ///< number of vertices that have stopped

  RandomDepths(SubdivisionLevel level, double span, std::uint32_t seed) {
    std::mt19937 random(seed);
    std::bernoulli_distribution stops(0.5);
    constexpr int kMoreLevels = 2;
    int more = -1;  // levels since all faces are small enough
    std::vector<bool> alive(level.mesh.cornerCount(), true);
    while (more < kMoreLevels) {
      level = nextLevel(level, imageVertices(level));
      const std::vector<double> around = facesAround(level.mesh);
      const bool small = *std::max_element(around.begin(), around.end()) <= span;
      if (more >= 0 || small) ++more;
      if (fine.points.empty() && test::naiveLargestSpan(level.mesh) <= 1) fine = level.mesh;
      bool some = false;
      for (Index v = 0; v < level.mesh.pointCount(); ++v) {
        if (!alive[v] || around[v] > span || (more < kMoreLevels && !stops(random))) continue;
        mask.tree().setValueOn(voxelOf(level.mesh.points[v]));
        alive[v] = false;
        some = true;
        ++vertices;
      }
      levels += some;
      std::vector<bool> children(level.mesh.cornerCount());
      for (Index c = 0; c < level.mesh.cornerCount(); ++c)
        children[c] = alive[level.mesh.faceVertices[c]];
      alive = std::move(children);
    }
  }
};

/// A closed shape in index space, its longest side `side` voxels long, at a random offset.
SubdivisionLevel placed(PolygonMesh mesh, double side, std::uint32_t seed) {
  RepairReport report;
  mesh = repair(std::move(mesh), {}, report);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> shift(-0.5, 0.5);
  const double scale = side / usedBox(mesh).longestSide();
  const Vec3d middle(shift(random), shift(random), shift(random));
  for (Vec3d& p : mesh.points) p = scale * p + middle;
  return baseLevel(std::move(mesh), BoundaryRule::kExtend);
}

}  // namespace

TEST_CASE("vertices may stop at any level once the faces around them fit into a voxel",
          "[voxelize][subdivide][property]") {
  std::size_t tried = 0;
  for (const auto& shape : test::shapes()) {
    if (!shape.closed || shape.mesh.faceCount() > 40) continue;
    for (std::uint32_t seed = 0; seed < 3; ++seed) {
      CAPTURE(shape.name, seed);
      const RandomDepths some(placed(shape.mesh, 9 + seed, seed), 1.0, seed);
      const test::Sides sides = test::sidesOf(some.fine, some.mask);
      CHECK(some.levels >= 2);
      CHECK(sides.outside > 0);
      CHECK(sides.leaks == 0);
      tried += sides.inside > 0;
    }
  }
  CHECK(tried > 10);
}

TEST_CASE("stopping where faces are larger than a voxel opens leaks", "[voxelize][property]") {
  std::size_t leaks = 0;
  for (std::uint32_t seed = 0; seed < 4; ++seed) {
    const RandomDepths some(placed(test::dodecahedron(), 12, seed), 1.7, seed);
    leaks += test::sidesOf(some.fine, some.mask).leaks;
  }
  CHECK(leaks > 0);  // the brute-force check can see them
}
