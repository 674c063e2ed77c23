// Sheets: union-find over faces, with a bit for the winding (WindingForest). Fans: union-find over
// corners.
// Cutting along singular edges and vertices: A. Gueziec, G. Taubin, F. Lazarus, W. Horn, Cutting
// and stitching: converting sets of polygons to manifold surfaces, 2001.

#include "libvox/prepare/manifold.h"

#include "libvox/core/error.h"
#include "libvox/core/forest.h"
#include "libvox/mesh/area_vector.h"
#include "libvox/mesh/winding_forest.h"
#include "libvox/prepare/face_order.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
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

void pairCrowdedEdges(const PolygonMesh& mesh, std::span<const EdgeCorner> edges,
                      Adjacency& adjacency) {
  EdgePairing pairing(mesh, adjacency);
  forEachEdge(edges, [&](std::span<const EdgeCorner> edge) {
    if (edge.size() > 2) pairing.pair(edge);
  });
}

/// Fans, as sets of corners.
Forest findFans(const PolygonMesh& mesh, const Adjacency& joints) {
  Forest fans(mesh.cornerCount());
  for (Index c = 0; c < mesh.cornerCount(); ++c) {
    const Index t = joints.twin[c];
    if (t == kNone || t < c) continue;
    const bool same = mesh.faceVertices[c] == mesh.faceVertices[t];
    const Index tNext = nextCorner(mesh, joints, t);
    fans.unite(c, same ? t : tNext);
    fans.unite(nextCorner(mesh, joints, c), same ? tNext : t);
  }
  return fans;
}

}  // namespace

Joints joinFaces(const PolygonMesh& mesh, CrowdedEdge crowded) {
  Joints joints{separateFaces(mesh), {}};
  const auto edges = cornersByEdge(mesh, joints.adjacency);
  forEachEdge(edges, [&](std::span<const EdgeCorner> edge) {
    if (edge.size() > 2) joints.crowdedEdges.push_back(edge[0].corner);
    if (edge.size() != 2) return;
    joints.adjacency.twin[edge[0].corner] = edge[1].corner;
    joints.adjacency.twin[edge[1].corner] = edge[0].corner;
  });
  if (crowded == CrowdedEdge::kPairSheets && !joints.crowdedEdges.empty())
    pairCrowdedEdges(mesh, edges, joints.adjacency);
  return joints;
}

std::vector<Index> splitFans(PolygonMesh& mesh, const Adjacency& joints) {
  Forest fans = findFans(mesh, joints);
  std::vector<bool> taken(mesh.pointCount(), false);
  std::vector<std::pair<Index, Index>> further;  // (vertex, lowest corner of the fan)
  for (Index c = 0; c < mesh.cornerCount(); ++c) {
    if (fans.find(c) != c) continue;
    const Index v = mesh.faceVertices[c];
    if (taken[v]) further.emplace_back(v, c);
    taken[v] = true;
  }
  if (further.empty()) return {};
  if (further.size() >= kNone - mesh.points.size())
    throw LimitError("repair would need 2^32 - 1 points or more");

  std::sort(further.begin(), further.end());
  std::vector<Index> newName(mesh.cornerCount(), kNone);  // slot: root of the fan
  std::vector<Index> copied;
  for (const auto& [v, root] : further) {
    newName[root] = mesh.pointCount();
    mesh.points.push_back(Vec3d(mesh.points[v]));
    copied.push_back(v);
  }
  for (Index c = 0; c < mesh.cornerCount(); ++c) {
    const Index name = newName[fans.find(c)];
    if (name != kNone) mesh.faceVertices[c] = name;
  }
  return copied;
}

}  // namespace vox
