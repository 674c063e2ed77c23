// Ranges of lower vertices as buckets; within a range a counting sort by the lower vertex.

#include "libvox/mesh/edge_ranges.h"

#include "libvox/core/parallel.h"

#include <algorithm>
#include <array>
#include <numeric>

namespace vox {
namespace {

constexpr Index kVerticesPerRange = 1024;

inline EdgeCorner edgeOf(const PolygonMesh& mesh, const Adjacency& adjacency, Index c) {
  const Index from = mesh.faceVertices[c];
  const Index to = mesh.faceVertices[nextCorner(mesh, adjacency, c)];
  return {std::min(from, to), std::max(from, to), c};
}

}  // namespace

EdgeRanges::EdgeRanges(const PolygonMesh& mesh, const Adjacency& adjacency)
    : mesh_(mesh),
      adjacency_(adjacency),
      corners_(mesh.faceCount(), mesh.pointCount() / kVerticesPerRange + 1,
               [&mesh](Index f, auto&& put) {
                 const Index end = mesh.faceOffsets[f + 1];
                 Index from = mesh.faceVertices[end - 1];
                 Index c = end - 1;
                 for (Index next = mesh.faceOffsets[f]; next != end; c = next++) {
                   const Index to = mesh.faceVertices[next];
                   put(std::min(from, to) / kVerticesPerRange, c);
                   from = to;
                 }
               }) {}

std::vector<EdgeCorner> EdgeRanges::corners(Index range) const {
  // A counting sort by the lower vertex; the few corners that share one are then sorted by edge.
  const std::span<const Index> unsorted = corners_[range];
  std::array<Index, kVerticesPerRange + 1> end{};
  std::vector<EdgeCorner> edges;
  edges.reserve(unsorted.size());
  for (const Index c : unsorted) {
    edges.push_back(edgeOf(mesh_, adjacency_, c));
    ++end[edges.back().low % kVerticesPerRange + 1];
  }
  std::partial_sum(end.begin(), end.end(), end.begin());
  std::vector<EdgeCorner> sorted(edges.size());
  for (const EdgeCorner& edge : edges) sorted[end[edge.low % kVerticesPerRange]++] = edge;
  for (auto begin = sorted.begin(); begin != sorted.end();) {
    const auto last = sorted.begin() + end[begin->low % kVerticesPerRange];
    std::sort(begin, last, [](const EdgeCorner& a, const EdgeCorner& b) {
      return a.high != b.high ? a.high < b.high : a.corner < b.corner;
    });
    begin = last;
  }
  return sorted;
}

}  // namespace vox
