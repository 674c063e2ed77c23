// Twin corners by sorting the edges; rings and loops by walking from twin to twin.

#include "libvox/mesh/adjacency.h"

#include "libvox/core/parallel.h"

#include <algorithm>

namespace vox {
namespace {

constexpr std::size_t kCornersPerTask = 8192;
constexpr std::size_t kFacesPerTask = 2048;

std::vector<Index> cornerFaces(const PolygonMesh& mesh) {
  std::vector<Index> cornerFace(mesh.cornerCount());
  forEach(mesh.faceCount(), kFacesPerTask, [&](Index f) {
    std::fill(cornerFace.begin() + mesh.faceOffsets[f],
              cornerFace.begin() + mesh.faceOffsets[f + 1], f);
  });
  return cornerFace;
}

}  // namespace

std::vector<EdgeCorner> cornersByEdge(const PolygonMesh& mesh, const Adjacency& adjacency) {
  std::vector<EdgeCorner> edges(mesh.cornerCount());
  forEach(mesh.cornerCount(), kCornersPerTask, [&](Index c) {
    const Index from = mesh.faceVertices[c];
    const Index to = mesh.faceVertices[nextCorner(mesh, adjacency, c)];
    edges[c] = {std::min(from, to), std::max(from, to), c};
  });
  sortInParallel(edges);
  return edges;
}

Adjacency buildAdjacency(const PolygonMesh& mesh) {
  Adjacency adjacency{std::vector<Index>(mesh.cornerCount(), kNone), cornerFaces(mesh)};
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
