// Ranges of lower vertices. Faces that stand together mostly have edges in the same few ranges, so
// a range keeps the runs of faces to look through. Within a range a counting sort by the lower
// vertex.

#include "libvox/mesh/edge_ranges.h"

#include "libvox/core/parallel.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <numeric>
#include <utility>

namespace vox {
namespace {

constexpr Index kVerticesPerRange = 4096;

Index rangeOf(Index lowerVertex) {
  return lowerVertex / kVerticesPerRange;
}

/// Order of the corners of edges with one lower vertex.
std::uint64_t key(const EdgeCorner& edge) {
  return std::uint64_t{edge.high} << 32U | edge.corner;
}

/// The first face of a run, and the one behind its last.
std::pair<Index, Index> facesOf(const PolygonMesh& mesh, Index run, Index facesPerRun) {
  const Index first = run * facesPerRun;
  return {first, first + std::min(facesPerRun, mesh.faceCount() - first)};
}

/// Calls visit(EdgeCorner) for the corners of a run of faces.
template <class Visit>
void forEachCornerOf(const PolygonMesh& mesh, Index run, Index facesPerRun, Visit&& visit) {
  const auto [first, last] = facesOf(mesh, run, facesPerRun);
  Index begin = mesh.faceOffsets[first];
  for (Index f = first; f < last; ++f) {
    const Index end = mesh.faceOffsets[f + 1];
    Index from = mesh.faceVertices[end - 1];
    Index c = end - 1;
    for (Index next = begin; next != end; c = next++) {
      const Index to = mesh.faceVertices[next];
      visit(EdgeCorner{std::min(from, to), std::max(from, to), c});
      from = to;
    }
    begin = end;
  }
}

/// Calls visit(range) for each range in which a run of faces has edges, once, and perhaps for one
/// more.
template <class Visit>
void forEachRangeOf(const PolygonMesh& mesh, Index run, Index facesPerRun, Visit&& visit) {
  const auto [first, last] = facesOf(mesh, run, facesPerRun);
  Index low = kNone;
  Index high = 0;
  for (Index c = mesh.faceOffsets[first]; c < mesh.faceOffsets[last]; ++c) {
    low = std::min(low, mesh.faceVertices[c]);
    high = std::max(high, mesh.faceVertices[c]);
  }
  visit(rangeOf(low));
  if (rangeOf(high) == rangeOf(low)) return;
  if (rangeOf(high) == rangeOf(low) + 1) return visit(rangeOf(high));
  std::vector<Index> seen{rangeOf(low)};
  forEachCornerOf(mesh, run, facesPerRun, [&](const EdgeCorner& edge) {
    const Index range = rangeOf(edge.low);
    if (std::find(seen.begin(), seen.end(), range) != seen.end()) return;
    seen.push_back(range);
    visit(range);
  });
}

Index runCount(const PolygonMesh& mesh, Index facesPerRun) {
  return mesh.faceCount() / facesPerRun + (mesh.faceCount() % facesPerRun == 0 ? 0 : 1);
}

/// Long runs, if a sample of them has edges in few ranges: otherwise most of a run is looked
/// through in vain.
Index chooseFacesPerRun(const PolygonMesh& mesh) {
  constexpr Index kLongRun = 64;
  constexpr Index kFewRanges = 4;
  constexpr Index kSampled = 61;
  Index ranges = 0;
  Index runs = 0;
  for (Index run = 0; run < runCount(mesh, kLongRun); run += kSampled, ++runs)
    forEachRangeOf(mesh, run, kLongRun, [&](Index) { ++ranges; });
  return ranges <= kFewRanges * runs ? kLongRun : 1;
}

}  // namespace

EdgeRanges::EdgeRanges(const PolygonMesh& mesh)
    : mesh_(mesh),
      facesPerRun_(chooseFacesPerRun(mesh)),
      runs_(runCount(mesh, facesPerRun_), mesh.pointCount() / kVerticesPerRange + 1,
            [&mesh, facesPerRun = facesPerRun_](Index run, auto&& put) {
              forEachRangeOf(mesh, run, facesPerRun, [&](Index range) { put(range, run); });
            }) {}

std::vector<EdgeCorner> EdgeRanges::corners(Index range) const {
  // A counting sort by the lower vertex; the few corners that share one are then sorted by edge.
  constexpr Index kOfTriangles = 6;  // corners of the edges with one lower vertex, on average
  std::array<Index, kVerticesPerRange + 1> end{};
  std::vector<EdgeCorner> edges;
  edges.reserve(std::min(mesh_.cornerCount(), kOfTriangles * kVerticesPerRange));
  for (const Index run : runs_[range])
    forEachCornerOf(mesh_, run, facesPerRun_, [&](const EdgeCorner& edge) {
      if (rangeOf(edge.low) != range) return;
      edges.push_back(edge);
      ++end[edge.low % kVerticesPerRange + 1];
    });
  std::partial_sum(end.begin(), end.end(), end.begin());
  std::vector<EdgeCorner> sorted(edges.size());
  for (const EdgeCorner& edge : edges) sorted[end[edge.low % kVerticesPerRange]++] = edge;
  for (auto begin = sorted.begin(); begin != sorted.end();) {
    const auto last = sorted.begin() + end[begin->low % kVerticesPerRange];
    std::sort(begin, last,
              [](const EdgeCorner& a, const EdgeCorner& b) { return key(a) < key(b); });
    begin = last;
  }
  return sorted;
}

}  // namespace vox
