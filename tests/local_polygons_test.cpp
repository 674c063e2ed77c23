#include "libvox/subdivide/local_polygons.h"

#include "libvox/grid/transform.h"
#include "libvox/localize/partition.h"
#include "libvox/mesh/area_vector.h"
#include "libvox/mesh/validate.h"
#include "libvox/prepare/repair.h"
#include "libvox/subdivide/doo_sabin.h"
#include "libvox/subdivide/stop.h"
#include "tests/repaired_level.h"
#include "tests/shapes.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <map>
#include <numeric>
#include <random>

using namespace vox;

namespace {

/// Collects the polygons of all pieces; points with the same bits become one.
class Welder : public PolygonSink {
 public:
  PolygonMesh mesh;

  void polygons(const PolygonMesh& piece) override {
    std::vector<Index> face;
    for (Index f = 0; f < piece.faceCount(); ++f) {
      face.clear();
      for (const Index v : piece.face(f)) face.push_back(numberOf(piece.points[v]));
      mesh.addFace(face);
    }
  }

 private:
  Index numberOf(const Vec3d& p) {
    const auto [entry, isNew] = numbers_.try_emplace({p.x(), p.y(), p.z()}, mesh.pointCount());
    if (isNew) mesh.points.push_back(p);
    return entry->second;
  }
  std::map<std::array<double, 3>, Index> numbers_;
};

PolygonMesh refined(const SubdivisionLevel& base, const std::vector<VertexDepth>& depths,
                    Index submeshFaces, const DepthRule* rule = nullptr) {
  Welder welder;
  LocalPolygons polygons(base);
  const Partition partition = coverGreedily(base.mesh, base.adjacency, submeshFaces);
  for (Index s = 0; s < partition.size(); ++s)
    polygons.emit(partition.submesh(s), depths, rule, welder);
  return welder.mesh;
}

std::vector<VertexDepth> uniform(const SubdivisionLevel& base, int k) {
  const auto depth = static_cast<std::uint8_t>(k);
  return {base.mesh.cornerCount(), VertexDepth{depth, depth}};
}

/// For each corner, whether its level-1 vertex is regular. For other vertices, depths along u and v
/// must be the same.
std::vector<std::uint8_t> regularCorners(const SubdivisionLevel& base) {
  const Index corners = base.mesh.cornerCount();
  std::vector<std::uint8_t> regular(corners);
  for (Index c = 0; c < corners; ++c) {
    if (base.mesh.faceSize(base.adjacency.cornerFace[c]) != 4) continue;
    const OneRing ring = oneRing(base.mesh, base.adjacency, c);
    const std::size_t half = base.boundary == BoundaryStage::kExtend ? 2 : ring.corners.size();
    regular[c] = ring.corners.size() == (ring.closed ? 4 : half);
  }
  return regular;
}

/// Random depths, so that deep and shallow vertices are neighbours; for regular vertices different
/// along u and v.
std::vector<VertexDepth> randomDepths(const SubdivisionLevel& base, int most, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_int_distribution<int> level(0, most);
  const auto next = [&] { return static_cast<std::uint8_t>(level(random)); };
  const auto regular = regularCorners(base);
  std::vector<VertexDepth> depths;
  for (const std::uint8_t isRegular : regular) {
    const std::uint8_t k = next();
    depths.push_back({k, isRegular ? next() : k});
  }
  return depths;
}

/// Calls check for every shape, with each boundary rule that makes a difference.
template <class Check>
void forShapes(Check&& check) {
  for (const auto* shapes : {&test::shapes(), &test::openShapes()})
    for (const auto& shape : *shapes)
      for (const auto rule : {BoundaryRule::kExtend, BoundaryRule::kFree}) {
        if (shape.closed && rule == BoundaryRule::kFree) continue;
        CAPTURE(shape.name, rule == BoundaryRule::kFree);
        check(test::repairedLevel(shape.mesh, rule));
      }
  const SubdivisionLevel cone = test::repairedLevel(test::pyramid(60), BoundaryRule::kExtend);
  CAPTURE("cone");
  check(cone);
}

std::size_t boundaryEdges(const PolygonMesh& mesh) {
  const Adjacency adjacency = buildAdjacency(mesh);
  return static_cast<std::size_t>(std::count(adjacency.twin.begin(), adjacency.twin.end(), kNone));
}

}  // namespace

TEST_CASE("at one depth everywhere, local polygons are the level of global Doo-Sabin",
          "[subdivide][localize][property]") {
  forShapes([](const SubdivisionLevel& base) {
    for (const int levels : {1, 2, 4}) {
      CAPTURE(levels);
      const SubdivisionLevel global = subdivide(base, levels);
      const PolygonMesh local = refined(base, uniform(base, levels - 1), 3);
      CHECK(local.faceCount() == global.mesh.faceCount());
      CHECK(local.cornerCount() == global.mesh.cornerCount());
      const Box extent = [&] {
        Box box;
        for (const Vec3d& p : base.mesh.points) box.add(p);
        return box;
      }();
      CHECK(test::samePoints(local.points, global.mesh.points, 1e-12 * extent.longestSide()));
      CHECK(boundaryEdges(local) == boundaryEdges(global.mesh));
    }
  });
}

TEST_CASE("polygons have no gaps for any depths", "[subdivide][localize][property]") {
  std::uint32_t seed = 0;
  forShapes([&](const SubdivisionLevel& base) {
    const SubdivisionLevel first = subdivide(base, 1);
    const auto characteristic = test::eulerCharacteristic(first.mesh);
    const std::size_t loops = boundaryLoops(first.mesh, first.adjacency).size();
    for (int i = 0; i < 3; ++i) {
      CAPTURE(++seed);
      const auto depths = randomDepths(base, 4, seed);
      const PolygonMesh mesh = refined(base, depths, 3);
      CHECK_NOTHROW(requireManifold(mesh, buildAdjacency(mesh)));
      CHECK(test::eulerCharacteristic(mesh) == characteristic);
      const Adjacency adjacency = buildAdjacency(mesh);
      CHECK(boundaryLoops(mesh, adjacency).size() == loops);
      if (loops == 0) CHECK(boundaryEdges(mesh) == 0);

      // Faces have the same bits for any partition.
      const PolygonMesh whole = refined(base, depths, 100000);
      CHECK(whole.faceCount() == mesh.faceCount());
      CHECK(test::samePoints(whole.points, mesh.points, 0));
    }
  });
}

TEST_CASE("polygons refined by a rule have no gaps, also with fewer vertices in thin parts",
          "[subdivide][localize][property]") {
  std::size_t saved = 0;
  for (const StopRule& until :
       {StopRule{{}, {}, {}, 0.05}, StopRule{{}, 4.0}, StopRule{{}, {}, 8.0}})
    forShapes([&](SubdivisionLevel base) {
      CAPTURE(stopRuleName(until));
      for (Vec3d& p : base.mesh.points) p *= 60;
      const SubdivisionLevel first = subdivide(base, 1);
      const DepthRule rule(until);
      std::vector<VertexDepth> depths(base.mesh.cornerCount());
      LocalPolygons polygons(base);
      const Partition partition = coverGreedily(base.mesh, base.adjacency, 3);
      for (Index s = 0; s < partition.size(); ++s)
        polygons.findDepths(partition.submesh(s), rule, depths);
      const PolygonMesh mesh = refined(base, depths, 3, &rule);
      const Adjacency adjacency = buildAdjacency(mesh);
      CHECK_NOTHROW(requireManifold(mesh, adjacency));
      CHECK(test::eulerCharacteristic(mesh) == test::eulerCharacteristic(first.mesh));
      CHECK(boundaryLoops(mesh, adjacency).size() ==
            boundaryLoops(first.mesh, first.adjacency).size());
      saved += mesh.pointCount() < refined(base, depths, 3).pointCount();
    });
  CHECK(saved > 10);
}

namespace {

/// Largest L-inf diameter of the faces.
double largestDiameter(const PolygonMesh& mesh) {
  double largest = 0;
  for (Index f = 0; f < mesh.faceCount(); ++f)
    for (const Index a : mesh.face(f))
      for (const Index b : mesh.face(f))
        largest = std::max(largest, (mesh.points[a] - mesh.points[b]).lpNorm<Eigen::Infinity>());
  return largest;
}

/// Distance of p from a triangle: the least of those from its plane, sides and corners.
double distanceFrom(const Vec3d& p, const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  const auto fromSide = [&](const Vec3d& s, const Vec3d& t) {
    const double length = (t - s).squaredNorm();
    const double at = length > 0 ? std::clamp((p - s).dot(t - s) / length, 0.0, 1.0) : 0;
    return (p - s - at * (t - s)).norm();
  };
  const double rim = std::min({fromSide(a, b), fromSide(b, c), fromSide(c, a)});
  const Vec3d n = (b - a).cross(c - a);
  if (n.norm() == 0) return rim;
  const auto inside = [&](const Vec3d& s, const Vec3d& t) {
    return (t - s).cross(p - s).dot(n) >= 0;
  };
  const bool above = inside(a, b) && inside(b, c) && inside(c, a);
  return above ? std::abs((p - a).dot(n)) / n.norm() : rim;
}

/// Largest distance of points from the faces of a mesh. Faces are cut into fans in both ways; the
/// smaller distance counts, because either way is allowed.
double farthest(const std::vector<Vec3d>& points, const PolygonMesh& mesh) {
  double farthest = 0;
  for (const Vec3d& p : points) {
    double nearest = 1e9;
    for (Index f = 0; f < mesh.faceCount(); ++f) {
      const auto face = mesh.face(f);
      const std::size_t n = face.size();
      for (std::size_t start = 0; start < std::min<std::size_t>(n, 2); ++start)
        for (std::size_t i = 1; i + 1 < n; ++i)
          nearest = std::min(
              nearest, distanceFrom(p, mesh.points[face[start]], mesh.points[face[(start + i) % n]],
                                    mesh.points[face[(start + i + 1) % n]]));
    }
    farthest = std::max(farthest, nearest);
  }
  return farthest;
}

PolygonMesh refinedTo(const SubdivisionLevel& base, const StopRule& until) {
  const DepthRule rule(until);
  std::vector<VertexDepth> depths(base.mesh.cornerCount());
  std::vector<Index> all(base.mesh.faceCount());
  std::iota(all.begin(), all.end(), Index{0});
  LocalPolygons(base).findDepths(all, rule, depths);
  return refined(base, depths, 100000, &rule);
}

}  // namespace

TEST_CASE("no face is larger than the rule says", "[subdivide][property]") {
  forShapes([](SubdivisionLevel base) {
    for (Vec3d& p : base.mesh.points) p *= 30;
    for (const double limit : {20.0, 3.0}) {
      CAPTURE(limit);
      CHECK(largestDiameter(refinedTo(base, StopRule{{}, limit})) <= limit * (1 + 1e-12));
    }
  });
}

TEST_CASE("neighbouring quads turn no more than the rule says", "[subdivide][property]") {
  double most = 0;
  forShapes([&](SubdivisionLevel base) {
    for (Vec3d& p : base.mesh.points) p *= 30;
    for (const double limit : {30.0, 12.0}) {
      CAPTURE(limit);
      StopRule until;
      until.angle = limit;
      const PolygonMesh mesh = refinedTo(base, until);
      const Adjacency adjacency = buildAdjacency(mesh);
      const auto normalOf = [&](Index f) {
        const auto face = mesh.face(f);
        return twiceAreaVector(face.size(), [&](std::size_t i) { return mesh.points[face[i]]; });
      };
      // Triangles stand where levels meet, and quads at boundaries.
      std::vector<bool> mayTurn(mesh.pointCount());
      for (Index c = 0; c < mesh.cornerCount(); ++c)
        if (mesh.faceSize(adjacency.cornerFace[c]) != 4 || adjacency.twin[c] == kNone)
          mayTurn[mesh.faceVertices[c]] = true;
      const auto counts = [&](Index f) {
        std::vector<Vec3d> corners;
        for (const Index v : mesh.face(f)) {
          if (mayTurn[v]) return false;
          corners.push_back(mesh.points[v]);
        }
        return diameter(corners) > 1;
      };
      for (Index c = 0; c < mesh.cornerCount(); ++c) {
        const Index twin = adjacency.twin[c];
        if (twin == kNone) continue;
        const Index f = adjacency.cornerFace[c];
        const Index g = adjacency.cornerFace[twin];
        if (!counts(f) || !counts(g)) continue;
        const Vec3d a = normalOf(f);
        const Vec3d b = normalOf(g);
        const double angle = std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / M_PI;
        CHECK(angle <= limit + 1e-6);
        most = std::max(most, angle / limit);
      }
    }
  });
  CHECK(most > 0.5);  // the bound is not idle
}

TEST_CASE("the polygons are as near the smooth surface as the rule says", "[subdivide][property]") {
  double most = 0;
  for (const PolygonMesh& mesh :
       {test::cube(), test::tetrahedron(), test::prism(7), test::pyramid(9), test::dodecahedron(),
        test::openFan(3, 5), test::sheet(3, 2)}) {
    SubdivisionLevel base = test::repairedLevel(mesh, BoundaryRule::kExtend);
    for (Vec3d& p : base.mesh.points) p *= 20;
    // The centroid of a face lies on the smooth surface.
    const PolygonMesh deep = subdivide(base, 5).mesh;
    std::vector<Vec3d> surface;
    const Index step = 1 + deep.faceCount() / 400;
    for (Index f = 0; f < deep.faceCount(); f += step)
      if (deep.faceSize(f) == 4) surface.push_back(test::faceCentroid(deep, f));
    for (const double limit : {1.0, 0.2}) {
      CAPTURE(limit, mesh.faceCount());
      const double distance = farthest(surface, refinedTo(base, StopRule{{}, {}, {}, limit}));
      CHECK(distance <= limit);
      most = std::max(most, distance / limit);
    }
  }
  CHECK(most > 0.2);  // the bound is not idle
}

TEST_CASE("tiles of large arrays have the same points as the pieces beside them",
          "[subdivide][localize]") {
  const SubdivisionLevel base = test::repairedLevel(test::tetrahedron(), BoundaryRule::kExtend);
  std::vector<VertexDepth> depths(base.mesh.cornerCount());
  depths[4] = {7, 7};
  const PolygonMesh mesh = refined(base, depths, 2);
  CHECK(mesh.pointCount() == 128 * 128 + base.mesh.cornerCount() - 1);
  CHECK(boundaryEdges(mesh) == 0);
}
