// Doo-Sabin subdivision of a whole mesh: the faces of the next level as loops over corners.
// D. Doo, M. Sabin, Behaviour of recursive division surfaces near extraordinary points, 1978;
// Cohen, Kaufman & Wang 1994, section 2.1.

#include "libvox/subdivide/doo_sabin.h"

#include "libvox/core/error.h"
#include "libvox/core/parallel.h"
#include "libvox/mesh/validate.h"
#include "libvox/subdivide/strip.h"

#include <algorithm>
#include <string>
#include <utility>

namespace vox {
namespace {

constexpr Index kCornersPerTask = 4096;

/// Numbers of the new faces and corners of the next level.
struct ChildLayout {
  Index edgeFaces = 0;          ///< number of E-faces
  Index vertexFaces = 0;        ///< number of whole V-faces
  std::vector<Index> boundary;  ///< boundary corners; number k has half E-face k and half V-face k
  std::vector<Index> edge;      ///< per corner that leads an edge: number of the E-face
  std::vector<Index> vFace;     ///< per corner that leads a one-ring: number of the V-face, else
                                ///< kNone; half V-faces come last, led by the boundary corner
  std::vector<Index> vFaceOffset;  ///< per V-face, + 1: first slot of the V-faces' corners
  std::vector<Index> vFaceSlot;    ///< per corner: its slot among the V-faces' corners, or kNone

  Index halfFaces() const { return static_cast<Index>(boundary.size()); }
};

std::vector<Index> ledOneRingSizes(const SubdivisionLevel& level) {
  std::vector<Index> sizes(level.mesh.cornerCount());
  parallelForEach(level.mesh.cornerCount(), kCornersPerTask,
                  [&](Index c) { sizes[c] = ledOneRingSize(level.mesh, level.adjacency, c); });
  return sizes;
}

void placeVFaceSlots(const SubdivisionLevel& level, ChildLayout& layout) {
  layout.vFaceSlot.assign(level.mesh.cornerCount(), kNone);
  parallelForEach(level.mesh.cornerCount(), kCornersPerTask, [&](Index c) {
    if (layout.vFace[c] == kNone) return;
    Index slot = layout.vFaceOffset[layout.vFace[c]];
    Index k = c;
    do {
      layout.vFaceSlot[k] = slot++;
      k = nextAroundVertex(level.mesh, level.adjacency, k);
    } while (k != kNone && k != c);
  });
}

/// Numbers the half V-faces: one for each boundary corner, with its fan of corners and two points
/// on the boundary.
void placeHalfVertexFaces(const SubdivisionLevel& level, ChildLayout& layout) {
  layout.boundary = boundaryCorners(level.adjacency);
  for (Index k = 0; k < layout.halfFaces(); ++k) {
    layout.vFace[layout.boundary[k]] = layout.vertexFaces + k;
    Index size = 2;
    for (Index c = layout.boundary[k]; c != kNone;
         c = nextAroundVertex(level.mesh, level.adjacency, c))
      ++size;
    layout.vFaceOffset.push_back(layout.vFaceOffset.back() + size);
  }
}

ChildLayout layOutChildren(const SubdivisionLevel& level) {
  ChildLayout layout;
  const Index corners = level.mesh.cornerCount();
  layout.edge.assign(corners, kNone);
  layout.vFace = ledOneRingSizes(level);
  layout.vFaceOffset.push_back(0);
  for (Index c = 0; c < corners; ++c) {
    if (leadsEdge(level.adjacency, c)) layout.edge[c] = layout.edgeFaces++;
    const Index valence = layout.vFace[c];
    layout.vFace[c] = valence < 3 ? kNone : layout.vertexFaces++;
    if (valence >= 3) layout.vFaceOffset.push_back(layout.vFaceOffset.back() + valence);
  }
  if (level.boundary == BoundaryStage::kExtend) placeHalfVertexFaces(level, layout);
  placeVFaceSlots(level, layout);
  return layout;
}

/// Writes the faces of the next level and their twins; every corner owns its slots.
///
/// The E-face of the edge c = v->w with twin t = w->v is [next c, c, next t, t]; its edges face, in
/// this order, the F-face edge c, the V-face of v, the F-face edge t, the V-face of w. The V-face
/// edge that starts at corner x leads to y = nextAroundVertex(x) and faces the E-face that runs
/// from y to x.
///
/// The half E-face of a boundary edge c = v->w is [next c, c, Mv, Mw] with Chaikin points M; its
/// edges face the F-face edge c, the half V-face of v, nothing, the half V-face of w. The half
/// V-face of a fan c1 .. cm is [c1 .. cm, Mend, Mstart], where Mend is near the vertex on the
/// boundary edge that arrives there and Mstart on the one that leaves, the edge c1.
class ChildTopology {
 public:
  ChildTopology(const SubdivisionLevel& level, const ChildLayout& layout, SubdivisionLevel& child)
      : mesh_(level.mesh),
        adjacency_(level.adjacency),
        layout_(layout),
        child_(child),
        firstEdgeCorner_(mesh_.cornerCount()),
        firstVFaceCorner_(firstEdgeCorner_ + 4 * layout.edgeFaces),
        firstHalfEdgeCorner_(firstVFaceCorner_ + layout.vFaceOffset.back()) {}

  void writeFaceOffsets() {
    auto& offsets = child_.mesh.faceOffsets;
    const Index firstHalfEdgeFace = faceOfVFace(layout_.vertexFaces + layout_.halfFaces());
    offsets.resize(std::size_t{firstHalfEdgeFace} + layout_.halfFaces() + 1);
    std::copy(mesh_.faceOffsets.begin(), mesh_.faceOffsets.end(), offsets.begin());
    for (Index e = 0; e < layout_.edgeFaces; ++e)
      offsets[mesh_.faceCount() + e] = firstEdgeCorner_ + 4 * e;
    for (Index v = 0; v < layout_.vertexFaces + layout_.halfFaces(); ++v)
      offsets[faceOfVFace(v)] = firstVFaceCorner_ + layout_.vFaceOffset[v];
    for (Index k = 0; k <= layout_.halfFaces(); ++k)
      offsets[firstHalfEdgeFace + k] = halfEdgeCorner(k, 0);
  }

  void writeFaceCorner(Index c) {
    const Index t = adjacency_.twin[c];
    Index twin = kNone;
    if (t != kNone)
      twin = c < t ? edgeCorner(c, 0) : edgeCorner(t, 2);
    else if (layout_.vFace[c] != kNone)
      twin = halfEdgeCorner(halfFaceOf(c), 0);
    set(c, c, twin);
  }

  void writeEdgeFace(Index c) {
    const Index t = adjacency_.twin[c];
    const Index nextC = nextCorner(mesh_, adjacency_, c);
    const Index nextT = nextCorner(mesh_, adjacency_, t);
    set(edgeCorner(c, 0), nextC, c);
    set(edgeCorner(c, 1), c, acrossVertex(nextT));
    set(edgeCorner(c, 2), nextT, t);
    set(edgeCorner(c, 3), t, acrossVertex(nextC));
  }

  void writeVertexFace(Index leader) {
    Index x = leader;
    do {
      set(vFaceCorner(x), x, edgeFacing(x));
      x = nextAroundVertex(mesh_, adjacency_, x);
    } while (x != leader);
  }

  void writeHalfVertexFace(Index k) {
    Index x = layout_.boundary[k];
    for (Index y = nextAroundVertex(mesh_, adjacency_, x); y != kNone;
         y = nextAroundVertex(mesh_, adjacency_, x)) {
      set(vFaceCorner(x), x, edgeFacing(x));
      x = y;
    }
    const Index arriving = halfFaceOf(previousCorner(mesh_, adjacency_, x));
    set(vFaceCorner(x), x, halfEdgeCorner(arriving, 3));
    set(vFaceCorner(x) + 1, boundaryPoint(arriving) + 1, kNone);
    set(vFaceCorner(x) + 2, boundaryPoint(k), halfEdgeCorner(k, 1));
  }

  void writeHalfEdgeFace(Index k) {
    const Index c = layout_.boundary[k];
    const Index nextC = nextCorner(mesh_, adjacency_, c);
    const Index afterVFace = firstVFaceCorner_ + layout_.vFaceOffset[layout_.vertexFaces + k + 1];
    set(halfEdgeCorner(k, 0), nextC, c);
    set(halfEdgeCorner(k, 1), c, afterVFace - 1);
    set(halfEdgeCorner(k, 2), boundaryPoint(k), kNone);
    set(halfEdgeCorner(k, 3), boundaryPoint(k) + 1, vFaceCorner(nextC));
  }

 private:
  Index faceOfVFace(Index vFace) const { return mesh_.faceCount() + layout_.edgeFaces + vFace; }
  Index vFaceCorner(Index x) const { return firstVFaceCorner_ + layout_.vFaceSlot[x]; }

  Index halfFaceOf(Index boundaryCorner) const {
    return layout_.vFace[boundaryCorner] - layout_.vertexFaces;
  }
  Index halfEdgeCorner(Index k, Index i) const { return firstHalfEdgeCorner_ + 4 * k + i; }

  /// First of the two Chaikin points of boundary edge k.
  Index boundaryPoint(Index k) const { return mesh_.cornerCount() + 2 * k; }

  Index edgeCorner(Index leader, Index i) const {
    return firstEdgeCorner_ + 4 * layout_.edge[leader] + i;
  }

  /// E-face corner whose edge runs from y = nextAroundVertex(x) to x.
  Index edgeFacing(Index x) const {
    const Index y = nextAroundVertex(mesh_, adjacency_, x);
    return leadsEdge(adjacency_, y) ? edgeCorner(y, 1) : edgeCorner(adjacency_.twin[y], 3);
  }

  /// Twin of the E-face edge that ends at corner x of the old level: the corner of the V-face; at a
  /// vertex with two faces the one of the other E-face; kNone at the boundary.
  Index acrossVertex(Index x) const {
    if (layout_.vFaceSlot[x] != kNone) return vFaceCorner(x);
    const Index y = nextAroundVertex(mesh_, adjacency_, x);
    const bool valenceTwo = y != kNone && nextAroundVertex(mesh_, adjacency_, y) == x;
    return valenceTwo ? edgeFacing(y) : kNone;
  }

  void set(Index corner, Index point, Index twin) {
    child_.mesh.faceVertices[corner] = point;
    child_.adjacency.twin[corner] = twin;
  }

  const PolygonMesh& mesh_;
  const Adjacency& adjacency_;
  const ChildLayout& layout_;
  SubdivisionLevel& child_;
  Index firstEdgeCorner_;
  Index firstVFaceCorner_;
  Index firstHalfEdgeCorner_;
};

void requireFits(std::uint64_t corners) {
  if (corners >= kNone)
    throw LimitError("the next subdivision level would have " + std::to_string(corners) +
                     " corners, more than fit in 32 bits; use fewer levels or larger voxels");
}

}  // namespace

SubdivisionLevel baseLevel(PolygonMesh mesh, BoundaryRule rule) {
  requireValidArrays(mesh);
  Adjacency adjacency = buildAdjacency(mesh);
  requireManifold(mesh, adjacency);
  return baseLevel(std::move(mesh), std::move(adjacency), rule);
}

SubdivisionLevel baseLevel(PolygonMesh mesh, Adjacency adjacency, BoundaryRule rule) {
  SubdivisionLevel level{std::move(mesh), std::move(adjacency), BoundaryStage::kPlain};
  const auto& twin = level.adjacency.twin;
  const Index corners = level.mesh.cornerCount();
  const bool open =
      lowestWhere(corners, kCornersPerTask, [&](Index c) { return twin[c] == kNone; }) < corners;
  if (open && rule != BoundaryRule::kFree) level.boundary = BoundaryStage::kExtend;
  return level;
}

Index ledOneRingSize(const PolygonMesh& mesh, const Adjacency& adjacency, Index c) {
  Index left = c;
  Index right = c;
  for (Index steps = 1;; ++steps) {
    left = nextAroundVertex(mesh, adjacency, left);
    if (left == kNone || left < c) return 0;
    if (left == c) return steps;
    right = previousAroundVertex(mesh, adjacency, right);
    if (right == kNone || right < c) return 0;
  }
}

std::uint64_t nextCornerCount(const SubdivisionLevel& level) {
  // Each interior edge has two corners and makes an E-face of four; each corner is in at most one
  // V-face. A boundary edge makes a half E-face of four and two more corners of a half V-face.
  std::uint64_t interior = 0;
  for (const Index t : level.adjacency.twin) interior += t != kNone;
  const std::uint64_t corners = level.mesh.cornerCount();
  const bool extends = level.boundary == BoundaryStage::kExtend;
  return 2 * corners + 2 * interior + (extends ? 6 * (corners - interior) : 0);
}

SubdivisionLevel nextLevel(const SubdivisionLevel& level, std::vector<Vec3d> image) {
  requireFits(nextCornerCount(level));
  const ChildLayout layout = layOutChildren(level);
  const Index corners = level.mesh.cornerCount();
  const std::size_t childCorners = corners +
                                   4 * (std::size_t{layout.edgeFaces} + layout.halfFaces()) +
                                   layout.vFaceOffset.back();

  SubdivisionLevel child;
  if (level.boundary != BoundaryStage::kPlain) child.boundary = BoundaryStage::kStrips;
  child.mesh.points = std::move(image);
  child.mesh.faceVertices.resize(childCorners);
  child.adjacency.twin.resize(childCorners);

  ChildTopology topology(level, layout, child);
  topology.writeFaceOffsets();
  child.adjacency.cornerFace = CornerFaces(child.mesh);
  parallelForEach(corners, kCornersPerTask, [&](Index c) {
    topology.writeFaceCorner(c);
    if (layout.edge[c] != kNone) topology.writeEdgeFace(c);
    if (layout.vFace[c] < layout.vertexFaces) topology.writeVertexFace(c);
  });
  parallelForEach(layout.halfFaces(), kCornersPerTask, [&](Index k) {
    topology.writeHalfVertexFace(k);
    topology.writeHalfEdgeFace(k);
  });
  return child;
}

SubdivisionLevel subdivide(SubdivisionLevel level, int levels) {
  for (int k = 0; k < levels; ++k) level = nextLevel(level, imageVertices(level));
  return level;
}

}  // namespace vox
