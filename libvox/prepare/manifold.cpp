// Sheets: union-find over faces, with a bit for the winding (WindingForest). Fans: walks from
// corner to corner around a vertex. Cutting along singular edges and vertices: A. Gueziec, G.
// Taubin, F. Lazarus, W. Horn, Cutting and stitching: converting sets of polygons to manifold
// surfaces, 2001.

#include "libvox/prepare/manifold.h"

#include "libvox/core/error.h"
#include "libvox/core/parallel.h"
#include "libvox/mesh/area_vector.h"
#include "libvox/mesh/edge_ranges.h"
#include "libvox/mesh/winding_forest.h"
#include "libvox/prepare/face_order.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <mutex>
#include <tuple>
#include <utility>

namespace vox {
namespace {

constexpr std::size_t kMostSheets = 32;  // the number of candidate pairs grows with its square

/// Newell normals of the faces. The normal of a reversed face is exactly the negative.
std::vector<Vec3d> faceNormals(const PolygonMesh& mesh) {
  PolygonMesh canonical = mesh;
  const auto reversed = canonicalizeFaces(canonical);
  std::vector<Vec3d> normals(mesh.faceCount(), Vec3d::Zero());
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    const auto face = canonical.face(f);
    normals[f] = twiceAreaVector(face.size(), [&](std::size_t i) { return mesh.points[face[i]]; });
    if (reversed[f]) normals[f] = -normals[f];
  }
  return normals;
}

/// Joins the faces of one crowded edge.
class EdgePairing {
 public:
  EdgePairing(const PolygonMesh& mesh, Adjacency& adjacency)
      : mesh_(mesh), adjacency_(adjacency), normals_(faceNormals(mesh)), sheets_(mesh.faceCount()) {
    for (Index c = 0; c < mesh.cornerCount(); ++c)
      if (adjacency.twin[c] != kNone && c < adjacency.twin[c]) noteJoint(c, adjacency.twin[c]);
  }

  void pair(std::span<const EdgeCorner> edge) {
    if (edge.size() > kMostSheets) return;
    auto candidates = candidatesOf(edge);
    std::sort(candidates.begin(), candidates.end());
    for (const Candidate& candidate : candidates) {
      const auto [second, cosine, a, b] = candidate;
      if (adjacency_.twin[a] != kNone || adjacency_.twin[b] != kNone || makesOneSided(a, b))
        continue;
      adjacency_.twin[a] = b;
      adjacency_.twin[b] = a;
      noteJoint(a, b);
    }
  }

 private:
  /// A pair of faces, in the order of joining: whether they belong to different sheets; the cosine
  /// of the angle between them (-1: flat); their two corners on the edge.
  using Candidate = std::tuple<bool, double, Index, Index>;

  std::vector<Candidate> candidatesOf(std::span<const EdgeCorner> edge) const {
    std::vector<Vec3d> inward;
    for (const EdgeCorner& side : edge) inward.push_back(inwardDirection(side.corner));
    std::vector<Candidate> candidates;
    for (std::size_t j = 1; j < edge.size(); ++j)
      for (std::size_t i = 0; i < j; ++i) {
        const double cosine = inward[i].dot(inward[j]);
        candidates.emplace_back(!ofOneSheet(edge[i].corner, edge[j].corner),
                                std::isfinite(cosine) ? cosine : 0, edge[i].corner, edge[j].corner);
      }
    return candidates;
  }

  /// Unit vector in the face of c, perpendicular to the edge of c; 0 if the face has no area.
  Vec3d inwardDirection(Index c) const {
    const Index next = nextCorner(mesh_, adjacency_, c);
    const Vec3d along =
        mesh_.points[mesh_.faceVertices[next]] - mesh_.points[mesh_.faceVertices[c]];
    return normals_[faceOf(c)].stableNormalized().cross(along.stableNormalized());
  }

  Index faceOf(Index c) const { return adjacency_.cornerFace[c]; }
  bool sameDirection(Index a, Index b) const {
    return mesh_.faceVertices[a] == mesh_.faceVertices[b];
  }
  void noteJoint(Index a, Index b) { sheets_.unite(faceOf(a), faceOf(b), sameDirection(a, b)); }
  bool ofOneSheet(Index a, Index b) const {
    return sheets_.find(faceOf(a)).root == sheets_.find(faceOf(b)).root;
  }
  bool makesOneSided(Index a, Index b) const {
    return sheets_.contradicts(faceOf(a), faceOf(b), sameDirection(a, b));
  }

  const PolygonMesh& mesh_;
  Adjacency& adjacency_;
  std::vector<Vec3d> normals_;
  WindingForest sheets_;
};

/// The corners of one fan, in the order of a walk around their vertex. The winding of the faces
/// does not matter.
class FanWalk {
 public:
  /// @param leaving  whether the first step crosses the edge that leaves the vertex in the face of
  ///                 c, or the one that arrives there
  FanWalk(const PolygonMesh& mesh, const Adjacency& joints, Index c, bool leaving)
      : mesh_(mesh), joints_(joints), vertex_(mesh.faceVertices[c]) {
    edge_ = leaving ? c : previousCorner(mesh, joints, c);
  }

  /// The next corner, or kNone where the fan ends.
  Index next() {
    const Index t = joints_.twin[edge_];
    if (t == kNone) return kNone;
    const bool leaves = mesh_.faceVertices[t] == vertex_;
    const Index corner = leaves ? t : nextCorner(mesh_, joints_, t);
    edge_ = leaves ? previousCorner(mesh_, joints_, t) : corner;
    return corner;
  }

 private:
  const PolygonMesh& mesh_;
  const Adjacency& joints_;
  Index vertex_;
  Index edge_ = kNone;
};

/// All corners of the fan of c.
std::vector<Index> fanOf(const PolygonMesh& mesh, const Adjacency& joints, Index c) {
  std::vector<Index> corners = {c};
  for (const bool leaving : {true, false}) {
    FanWalk walk(mesh, joints, c, leaving);
    Index corner = walk.next();
    for (; corner != kNone && corner != c; corner = walk.next()) corners.push_back(corner);
    if (corner == c) break;  // a closed fan
  }
  return corners;
}

/// Whether c is the lowest corner of its fan. The two walks take turns, so that all corners of a
/// fan of n together take O(n log n) steps.
bool isLowestOfFan(const PolygonMesh& mesh, const Adjacency& joints, Index c) {
  FanWalk first(mesh, joints, c, true);
  FanWalk second(mesh, joints, c, false);
  for (Index left = c, right = c; left != kNone || right != kNone;) {
    if (left != kNone) left = first.next();
    if (left <= c) return left == c;
    if (right != kNone) right = second.next();
    if (right <= c) return right == c;
  }
  return true;
}

/// For each vertex, how many fans it has: 0, 1, or 2 for several.
std::vector<std::uint8_t> fanCounts(const PolygonMesh& mesh, const Adjacency& joints) {
  std::vector<std::uint8_t> fans(mesh.pointCount(), 0);
  parallelForEach(mesh.cornerCount(), kElementsPerTask, [&](Index c) {
    if (!isLowestOfFan(mesh, joints, c)) return;
    std::atomic_ref<std::uint8_t> known(fans[mesh.faceVertices[c]]);
    std::uint8_t none = 0;
    if (!known.compare_exchange_strong(none, 1)) known.store(2);
  });
  return fans;
}

/// A fan, and the vertex that it has in common with others.
struct SharedFan {
  Index vertex;
  Index lowest;  ///< corner
  auto operator<=>(const SharedFan&) const = default;
};

/// The fans that need a vertex of their own, sorted: at each vertex, all but the lowest.
std::vector<SharedFan> furtherFans(const PolygonMesh& mesh, const Adjacency& joints) {
  const std::vector<std::uint8_t> fans = fanCounts(mesh, joints);
  std::vector<SharedFan> shared;
  if (std::find(fans.begin(), fans.end(), 2) == fans.end()) return shared;
  for (Index c = 0; c < mesh.cornerCount(); ++c)
    if (fans[mesh.faceVertices[c]] > 1 && isLowestOfFan(mesh, joints, c))
      shared.push_back({mesh.faceVertices[c], c});
  std::sort(shared.begin(), shared.end());
  std::vector<SharedFan> further;
  for (std::size_t k = 1; k < shared.size(); ++k)
    if (shared[k].vertex == shared[k - 1].vertex) further.push_back(shared[k]);
  return further;
}

}  // namespace

Joints joinFaces(const PolygonMesh& mesh, CrowdedEdge crowded) {
  Joints joints{separateFaces(mesh), {}};
  std::vector<EdgeCorner> crowdedCorners;
  std::mutex lock;
  forEachEdgeInParallel(mesh, [&](std::span<const EdgeCorner> edge) {
    if (edge.size() == 2) {
      joints.adjacency.twin[edge[0].corner] = edge[1].corner;
      joints.adjacency.twin[edge[1].corner] = edge[0].corner;
    } else if (edge.size() > 2) {
      const std::lock_guard guard(lock);
      crowdedCorners.insert(crowdedCorners.end(), edge.begin(), edge.end());
    }
  });
  if (crowdedCorners.empty()) return joints;
  parallelSort(crowdedCorners);
  forEachEdge(crowdedCorners, [&](std::span<const EdgeCorner> edge) {
    joints.crowdedEdges.push_back(edge[0].corner);
  });
  if (crowded == CrowdedEdge::kSeparate) return joints;
  EdgePairing pairing(mesh, joints.adjacency);
  forEachEdge(crowdedCorners, [&](std::span<const EdgeCorner> edge) { pairing.pair(edge); });
  return joints;
}

std::vector<Index> splitFans(PolygonMesh& mesh, const Adjacency& joints) {
  const std::vector<SharedFan> further = furtherFans(mesh, joints);
  if (further.size() >= kNone - mesh.points.size())
    throw LimitError("repair would need 2^32 - 1 points or more");
  std::vector<Index> copied;
  for (const auto& [v, lowest] : further) {
    for (const Index c : fanOf(mesh, joints, lowest)) mesh.faceVertices[c] = mesh.pointCount();
    mesh.points.push_back(Vec3d(mesh.points[v]));
    copied.push_back(v);
  }
  return copied;
}

}  // namespace vox
