#pragma once

#include "libvox/mesh/polygon_mesh.h"

#include <compare>
#include <cstdint>
#include <span>
#include <vector>

namespace vox {

/// The face of each corner of a mesh. Takes no memory if all faces are triangles.
class CornerFaces {
 public:
  CornerFaces() = default;
  explicit CornerFaces(const PolygonMesh& mesh);

  Index operator[](Index corner) const { return faces_.empty() ? corner / 3 : faces_[corner]; }
  bool areTriangles() const { return faces_.empty(); }
  std::uint64_t bytes() const { return faces_.size() * sizeof(Index); }
  bool operator==(const CornerFaces&) const = default;

 private:
  std::vector<Index> faces_;  // empty: triangles
};

/// Neighbours of the corners of a mesh, by corner.
struct Adjacency {
  std::vector<Index> twin;  ///< corner of the neighbouring face on the same edge, or kNone
  CornerFaces cornerFace;   ///< face of the corner
};

/// Adjacency of a mesh whose faces have at least 3 corners.
///
/// Two corners are twins if they are the only two on their edge and run through it in opposite
/// directions. Every other edge (boundary, three and more faces, inconsistent winding, from a
/// vertex to itself) separates its faces: its corners get kNone. So the twins of any mesh form an
/// oriented manifold with boundary.
///
/// Cost O(C log n) with up to n corners around a vertex. Parallel; result independent of thread
/// count.
Adjacency buildAdjacency(const PolygonMesh& mesh);

/// Adjacency without any twins. Cost O(C).
Adjacency separateFaces(const PolygonMesh& mesh);

/// A corner and the undirected edge that starts at it.
struct EdgeCorner {
  Index low;     ///< smaller vertex of the edge
  Index high;    ///< larger vertex; equal to low if two neighbouring corners have the same vertex
  Index corner;  ///< the corner
  auto operator<=>(const EdgeCorner&) const = default;
};

/// All corners sorted by edge, then by corner, so that the corners on one edge stand together.
/// Parallel.
std::vector<EdgeCorner> cornersByEdge(const PolygonMesh& mesh);

/// Calls visit(span of EdgeCorner) for each edge of a list from cornersByEdge. Serial.
template <class Visit>
void forEachEdge(std::span<const EdgeCorner> corners, Visit&& visit) {
  for (std::size_t first = 0, last = 0; first < corners.size(); first = last) {
    while (last < corners.size() && corners[last].low == corners[first].low &&
           corners[last].high == corners[first].high)
      ++last;
    visit(corners.subspan(first, last - first));
  }
}

/// Next and previous corner in the same face.
inline Index nextCorner(const PolygonMesh& mesh, const Adjacency& adjacency, Index c) {
  const Index f = adjacency.cornerFace[c];
  if (adjacency.cornerFace.areTriangles()) return c == 3 * f + 2 ? 3 * f : c + 1;
  return c + 1 == mesh.faceOffsets[f + 1] ? mesh.faceOffsets[f] : c + 1;
}
inline Index previousCorner(const PolygonMesh& mesh, const Adjacency& adjacency, Index c) {
  const Index f = adjacency.cornerFace[c];
  if (adjacency.cornerFace.areTriangles()) return c == 3 * f ? c + 2 : c - 1;
  return c == mesh.faceOffsets[f] ? mesh.faceOffsets[f + 1] - 1 : c - 1;
}

/// Corner of the next face counter-clockwise around the vertex of c, or kNone at the boundary.
inline Index nextAroundVertex(const PolygonMesh& mesh, const Adjacency& adjacency, Index c) {
  return adjacency.twin[previousCorner(mesh, adjacency, c)];
}
/// Corner of the next face clockwise around the vertex of c, or kNone at the boundary.
inline Index previousAroundVertex(const PolygonMesh& mesh, const Adjacency& adjacency, Index c) {
  const Index t = adjacency.twin[c];
  return t == kNone ? kNone : nextCorner(mesh, adjacency, t);
}

/// The corners at the vertex of corner c whose faces are connected to the face of c through edges
/// at the vertex.
struct OneRing {
  std::vector<Index> corners;  ///< counter-clockwise; a closed ring starts at c, an open one at the
                               ///< corner whose outgoing edge is boundary
  bool closed = false;         ///< false: the ring ends at the boundary on both sides
};
OneRing oneRing(const PolygonMesh& mesh, const Adjacency& adjacency, Index c);

/// Boundary loops: each a cyclic list of corners whose edges have no twin, so that the edge of each
/// corner ends where the edge of the next one starts. Every boundary corner is in exactly one loop.
/// A loop starts at its lowest corner; loops are ordered by their first corner. Cost O(C).
std::vector<std::vector<Index>> boundaryLoops(const PolygonMesh& mesh, const Adjacency& adjacency);

}  // namespace vox
