#include "libvox/subdivide/local_surface.h"

#include "libvox/grid/transform.h"
#include "libvox/localize/partition.h"
#include "libvox/prepare/repair.h"
#include "libvox/subdivide/doo_sabin.h"
#include "libvox/subdivide/fan_vertices.h"
#include "libvox/subdivide/global_surface.h"
#include "tests/shapes.h"

#include <catch2/catch.hpp>
#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <map>
#include <numeric>
#include <random>
#include <vector>

using namespace vox;

namespace {

/// A closed bar much longer than wide, at an angle to the axes.
PolygonMesh bar(double length) {
  PolygonMesh mesh = test::cube();
  for (Vec3d& p : mesh.points) {
    p.x() *= length;
    p = Vec3d(0.8 * p.x() - 0.6 * p.y(), 0.6 * p.x() + 0.8 * p.y(), p.z());
  }
  return mesh;
}

/// A closed rough surface of triangles around vertices of 4 to 8 edges.
PolygonMesh roughTriangles() {
  const PolygonMesh quads = test::torusGrid(16, 8);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> shift(-0.08, 0.08);
  PolygonMesh mesh;
  for (const Vec3d& p : quads.points)
    mesh.points.push_back(p + Vec3d(shift(random), shift(random), shift(random)));
  for (Index f = 0; f < quads.faceCount(); ++f) {
    const auto q = quads.face(f);
    const std::size_t first = random() % 2;
    mesh.addFace(std::array{q[first], q[first + 1], q[first + 2]});
    mesh.addFace(std::array{q[first], q[first + 2], q[(first + 3) % 4]});
  }
  return mesh;
}

/// Collects all vertices, by level; expands patches by their definition.
class Collector : public SurfaceSink {
 public:
  std::map<int, std::vector<Vec3d>> vertices;

  void points(std::span<const Vec3d> points, int level) override {
    vertices[level].insert(vertices[level].end(), points.begin(), points.end());
  }
  void patch(const Patch& patch, int k, int level) override {
    const std::int64_t n = std::int64_t{1} << k;
    const auto& p = patch.points;
    for (std::int64_t i = 0; i < n; ++i)
      for (std::int64_t j = 0; j < n; ++j) {
        if (!wanted(patch.quadrants, i, j, n)) continue;
        const PatchWeights u(i, n);
        const PatchWeights v(j, n);
        vertices[level].push_back(v(u(p[0][0], p[1][0], p[2][0]), u(p[0][1], p[1][1], p[2][1]),
                                    u(p[0][2], p[1][2], p[2][2])));
      }
  }
  void curve(const CurvePoints& points, int k, int level) override {
    const std::int64_t n = std::int64_t{1} << k;
    for (std::int64_t j = 0; j < n; ++j)
      vertices[level].push_back(PatchWeights(j, n)(points[0], points[1], points[2]));
  }

 private:
  /// Whether a descendant exists: at every level, the face of the quadrant in which it lies must
  /// exist.
  static bool wanted(unsigned quadrants, std::int64_t i, std::int64_t j, std::int64_t n) {
    while (n > 1) {
      n /= 2;
      const bool highU = i >= n;
      const bool highV = j >= n;
      const unsigned own = 2U * highU + highV;
      const unsigned acrossU = own ^ 2U;
      const unsigned acrossV = own ^ 1U;
      const auto has = [&](unsigned q) { return (quadrants >> q & 1U) != 0; };
      if (!has(own)) return false;
      // One face of the child lies within the parent's face; those towards the sides are on edges.
      unsigned child = 1U << own;
      if (has(acrossU)) child |= 1U << acrossU;
      if (has(acrossV)) child |= 1U << acrossV;
      if (quadrants == kAllQuadrants) child |= 1U << (3U - own);
      quadrants = child;
      i -= highU ? n : 0;
      j -= highV ? n : 0;
    }
    return true;
  }
};

Collector locally(const SubdivisionLevel& base, Index submeshFaces) {
  Collector sink;
  LocalSurface surface(base);
  const Partition partition = coverGreedily(base.mesh, base.adjacency, submeshFaces);
  for (Index s = 0; s < partition.size(); ++s) surface.emit(partition.submesh(s), sink);
  return sink;
}

/// What fans make, and the rest by submeshes.
/// @param byFans  number of vertices of the base around which fans made all
Collector densely(const SubdivisionLevel& base, std::ptrdiff_t& byFans) {
  Collector sink;
  FanVertices fans(base);
  std::vector<std::uint8_t> made(base.mesh.pointCount(), 0);
  for (Index c = 0; c < base.mesh.cornerCount(); ++c) {
    const Index valence = ledOneRingSize(base.mesh, base.adjacency, c);
    if (valence > 0) made[base.mesh.faceVertices[c]] = fans.emit(c, valence, &sink);
  }
  fans.flush(sink);
  byFans = std::count(made.begin(), made.end(), 1);
  LocalSurface surface(base);
  surface.leaveOut(made);
  const Partition partition = coverGreedily(base.mesh, base.adjacency, 3);
  for (Index s = 0; s < partition.size(); ++s) surface.emit(partition.submesh(s), sink);
  return sink;
}

Collector globally(const SubdivisionLevel& base) {
  Collector sink;
  emitGlobally(base, sink, [](const SubdivisionLevel&) {});
  return sink;
}

SubdivisionLevel scaled(PolygonMesh mesh, double size, BoundaryRule rule) {
  for (Vec3d& p : mesh.points) p *= size;
  return baseLevel(std::move(mesh), rule);
}

void requireSame(const Collector& a, const Collector& b) {
  REQUIRE(a.vertices.size() == b.vertices.size());
  for (const auto& [level, vertices] : a.vertices) {
    CAPTURE(level, vertices.size());
    REQUIRE(b.vertices.count(level) == 1);
    REQUIRE(vertices.size() == b.vertices.at(level).size());
    CHECK(test::samePoints(vertices, b.vertices.at(level), 1e-9));
  }
}

}  // namespace

TEST_CASE("submeshes emit the vertices of the whole mesh, each once and at its level",
          "[subdivide][localize][property]") {
  for (const auto* shapes : {&test::shapes(), &test::openShapes()})
    for (const auto& shape : *shapes)
      for (const double size : {0.4, 3.0, 17.0})
        for (const auto rule : {BoundaryRule::kExtend, BoundaryRule::kFree}) {
          if (shape.closed && rule == BoundaryRule::kFree) continue;
          CAPTURE(shape.name, size, rule == BoundaryRule::kFree);
          RepairReport report;
          const SubdivisionLevel base = scaled(repair(shape.mesh, {}, report), size, rule);
          const Collector whole = globally(base);
          for (const Index faces : {1U, 3U, 1000U}) requireSame(locally(base, faces), whole);
        }
}

TEST_CASE("vertices of triangles, made many at a time, are those of the whole mesh",
          "[subdivide][localize][property]") {
  for (const double size : {2.0, 5.0, 11.0, 30.0}) {
    CAPTURE(size);
    const SubdivisionLevel base = scaled(roughTriangles(), size, BoundaryRule::kExtend);
    const Collector whole = globally(base);
    for (const Index faces : {1U, 37U, 1000U}) requireSame(locally(base, faces), whole);
  }
}

TEST_CASE("every instruction set makes the same vertices of triangles, bit for bit",
          "[subdivide][simd]") {
  const SubdivisionLevel base = scaled(roughTriangles(), 8, BoundaryRule::kExtend);
  const auto make = [&] {
    std::map<int, std::vector<std::array<double, 3>>> sorted;
    for (const auto& [level, vertices] : locally(base, 100).vertices) {
      for (const Vec3d& v : vertices) sorted[level].push_back({v.x(), v.y(), v.z()});
      std::sort(sorted[level].begin(), sorted[level].end());
    }
    return sorted;
  };
  const auto best = make();
  CHECK(best.count(2) + best.count(3) == 2);
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    CAPTURE(hwy::TargetName(target));
    hwy::GetChosenTarget().Update(target);
    CHECK((make() == best));
  }
  hwy::GetChosenTarget().DeInit();
}

TEST_CASE("fans of dense meshes make the vertices of the whole mesh, or leave all of a fan",
          "[subdivide][property]") {
  std::ptrdiff_t most = 0;
  for (const auto* shapes : {&test::shapes(), &test::openShapes()})
    for (const auto& shape : *shapes)
      for (const double size : {0.1, 0.7, 1.2, 2.0, 3.5}) {
        CAPTURE(shape.name, size);
        RepairReport report;
        const SubdivisionLevel base =
            scaled(repair(shape.mesh, {}, report), size, BoundaryRule::kExtend);
        std::ptrdiff_t byFans = 0;
        requireSame(densely(base, byFans), globally(base));
        most = std::max(most, byFans);
        const bool tiny = usedBox(base.mesh).longestSide() < 0.5;
        if (shape.closed && tiny && largestNeighbourhood(base.mesh) <= 8)
          CHECK(byFans == base.mesh.pointCount());
      }
  CHECK(most > 30);
  for (const double size : {2.0, 5.0, 8.0, 11.0, 20.0}) {
    CAPTURE(size);
    const SubdivisionLevel base = scaled(test::torusGrid(24, 64), size, BoundaryRule::kExtend);
    std::ptrdiff_t byFans = 0;
    requireSame(densely(base, byFans), globally(base));
    CHECK(byFans > (size < 6 ? 1000 : 0));
  }
}

TEST_CASE("the vertices of long thin patches are few, and the same for every partition",
          "[subdivide][localize][property]") {
  const SubdivisionLevel base = scaled(test::torusGrid(4, 64), 60.0, BoundaryRule::kExtend);
  const Collector whole = globally(base);
  for (const Index faces : {1U, 1000U}) requireSame(locally(base, faces), whole);
  std::size_t count = 0;
  for (const auto& [level, vertices] : whole.vertices) count += vertices.size();
  // With square arrays, each of the 1024 corners would have as many descendants along the short
  // side as along the long one.
  const int deepest = whole.vertices.rbegin()->first;
  CHECK(count < (std::size_t{1024} << (2 * (deepest - 1))) / 8);
}

TEST_CASE("a walker does not read the faces of the submesh before", "[subdivide][localize]") {
  const SubdivisionLevel base = scaled(test::torusGrid(4, 8), 10.0, BoundaryRule::kExtend);
  std::vector<Index> all(base.mesh.faceCount());
  std::iota(all.begin(), all.end(), 0);
  std::vector<Index> overwritten = all;
  LocalSurface surface(base);
  Collector first, again;
  surface.emit(overwritten, first);
  std::fill(overwritten.begin(), overwritten.end(), kNone);
  surface.emit(all, again);
  requireSame(again, first);
}

TEST_CASE("a long bar at an angle to the axes is the same for every partition",
          "[subdivide][localize][property]") {
  RepairReport report;
  const SubdivisionLevel base = scaled(repair(bar(40), {}, report), 2.0, BoundaryRule::kExtend);
  const Collector whole = globally(base);
  for (const Index faces : {1U, 1000U}) requireSame(locally(base, faces), whole);
}
