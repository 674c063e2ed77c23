// Twin corners: the corners of all edges are sorted by edge. One-rings and boundary loops: a walk
// from twin to twin.

#include "libvox/mesh/adjacency.h"

#include "libvox/core/parallel.h"
#include "libvox/mesh/edge_ranges.h"

#include <algorithm>

namespace vox {

std::vector<EdgeCorner> cornersByEdge(const PolygonMesh& mesh) {
  const EdgeRanges ranges(mesh);
  std::vector<std::vector<EdgeCorner>> sorted(ranges.size());
  parallelForEach(ranges.size(), 1, [&](Index range) { sorted[range] = ranges.corners(range); });
  std::vector<EdgeCorner> edges;
  edges.reserve(mesh.cornerCount());
  for (const std::vector<EdgeCorner>& part : sorted)
    edges.insert(edges.end(), part.begin(), part.end());
  return edges;
}

CornerFaces::CornerFaces(const PolygonMesh& mesh) {
  const Index count = mesh.faceCount();
  const auto isElsewhere = [&](Index f) { return mesh.faceOffsets[f + 1] != 3 * (f + 1); };
  if (lowestWhere(count, kElementsPerTask, isElsewhere) == count) return;
  faces_.resize(mesh.cornerCount());
  parallelForEach(count, kElementsPerTask, [&](Index f) {
    std::fill(faces_.begin() + mesh.faceOffsets[f], faces_.begin() + mesh.faceOffsets[f + 1], f);
  });
}

Adjacency separateFaces(const PolygonMesh& mesh) {
  return {std::vector<Index>(mesh.cornerCount(), kNone), CornerFaces(mesh)};
}

Adjacency buildAdjacency(const PolygonMesh& mesh) {
  Adjacency adjacency = separateFaces(mesh);
  forEachEdgeInParallel(mesh, [&](std::span<const EdgeCorner> edge) {
    if (edge.size() != 2 || edge[0].low == edge[0].high) return;
    const Index a = edge[0].corner;
    const Index b = edge[1].corner;
    if (mesh.faceVertices[a] == mesh.faceVertices[b]) return;  // same direction: a flipped face
    adjacency.twin[a] = b;
    adjacency.twin[b] = a;
  });
  return adjacency;
}

OneRing oneRing(const PolygonMesh& mesh, const Adjacency& adjacency, Index c) {
  Index start = c;
  bool closed = false;
  for (Index back = previousAroundVertex(mesh, adjacency, c); back != kNone && !closed;
       back = previousAroundVertex(mesh, adjacency, back)) {
    start = back;
    closed = back == c;
  }

  OneRing ring{{start}, closed};
  for (Index k = nextAroundVertex(mesh, adjacency, start); k != kNone && k != start;
       k = nextAroundVertex(mesh, adjacency, k))
    ring.corners.push_back(k);
  return ring;
}

std::vector<std::vector<Index>> boundaryLoops(const PolygonMesh& mesh, const Adjacency& adjacency) {
  std::vector<std::vector<Index>> loops;
  const Index corners = mesh.cornerCount();
  const Index lowest =
      lowestWhere(corners, kElementsPerTask, [&](Index c) { return adjacency.twin[c] == kNone; });
  if (lowest == corners) return loops;
  std::vector<bool> visited(mesh.cornerCount(), false);
  for (Index first = lowest; first < mesh.cornerCount(); ++first) {
    if (adjacency.twin[first] != kNone || visited[first]) continue;
    auto& loop = loops.emplace_back();
    for (Index c = first; !visited[c];) {
      visited[c] = true;
      loop.push_back(c);
      // Turn around the end of this edge, face by face, until the next boundary edge leaves it.
      c = nextCorner(mesh, adjacency, c);
      while (adjacency.twin[c] != kNone) c = nextCorner(mesh, adjacency, adjacency.twin[c]);
    }
  }
  return loops;
}

}  // namespace vox
