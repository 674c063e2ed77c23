// Twin corners: the corners of all edges are sorted by edge. One-rings and boundary loops: a walk
// from twin to twin.

#include "libvox/mesh/adjacency.h"

#include "libvox/core/parallel.h"

#include <algorithm>
#include <numeric>

namespace vox {
namespace {

constexpr std::size_t kFacesPerTask = 2048;
constexpr std::size_t kVerticesPerTask = 4096;

}  // namespace

std::vector<EdgeCorner> cornersByEdge(const PolygonMesh& mesh, const Adjacency& adjacency) {
  const auto edgeOf = [&](Index c) -> EdgeCorner {
    const Index from = mesh.faceVertices[c];
    const Index to = mesh.faceVertices[nextCorner(mesh, adjacency, c)];
    return {std::min(from, to), std::max(from, to), c};
  };
  // A counting sort by the lower vertex; the few corners that share one are then sorted by edge.
  std::vector<Index> end(std::size_t{mesh.pointCount()} + 1, 0);
  for (Index c = 0; c < mesh.cornerCount(); ++c) ++end[std::size_t{edgeOf(c).low} + 1];
  std::partial_sum(end.begin(), end.end(), end.begin());
  std::vector<EdgeCorner> edges(mesh.cornerCount());
  for (Index c = 0; c < mesh.cornerCount(); ++c) {
    const EdgeCorner edge = edgeOf(c);
    edges[end[edge.low]++] = edge;
  }
  parallelForEach(mesh.pointCount(), kVerticesPerTask, [&](Index v) {
    const Index begin = v == 0 ? 0 : end[v - 1];
    std::sort(edges.begin() + begin, edges.begin() + end[v]);
  });
  return edges;
}

Adjacency separateFaces(const PolygonMesh& mesh) {
  Adjacency adjacency{std::vector<Index>(mesh.cornerCount(), kNone),
                      std::vector<Index>(mesh.cornerCount())};
  parallelForEach(mesh.faceCount(), kFacesPerTask, [&](Index f) {
    std::fill(adjacency.cornerFace.begin() + mesh.faceOffsets[f],
              adjacency.cornerFace.begin() + mesh.faceOffsets[f + 1], f);
  });
  return adjacency;
}

Adjacency buildAdjacency(const PolygonMesh& mesh) {
  Adjacency adjacency = separateFaces(mesh);
  forEachEdge(cornersByEdge(mesh, adjacency), [&](std::span<const EdgeCorner> edge) {
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
  std::vector<bool> visited(mesh.cornerCount(), false);
  for (Index first = 0; first < mesh.cornerCount(); ++first) {
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
