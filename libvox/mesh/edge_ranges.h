#pragma once

#include "libvox/core/buckets.h"
#include "libvox/mesh/adjacency.h"

#include <vector>

namespace vox {

/// The corners of a mesh by edge, as cornersByEdge sorts them, one range of lower vertices after
/// the other. Takes less memory, and each range stays in a cache.
class EdgeRanges {
 public:
  EdgeRanges(const PolygonMesh& mesh, const Adjacency& adjacency);

  Index size() const { return corners_.size(); }
  /// Corners of the edges whose lower vertices are in range number `range`. Thread-safe.
  std::vector<EdgeCorner> corners(Index range) const;

 private:
  const PolygonMesh& mesh_;
  const Adjacency& adjacency_;
  Buckets<Index> corners_;
};

/// Calls visit(span of EdgeCorner) for each edge of a mesh, once, from any thread.
template <class Visit>
void forEachEdgeInParallel(const PolygonMesh& mesh, const Adjacency& adjacency, Visit&& visit) {
  const EdgeRanges ranges(mesh, adjacency);
  parallelForEach(ranges.size(), 1, [&](Index range) {
    const std::vector<EdgeCorner> corners = ranges.corners(range);
    forEachEdge(corners, visit);
  });
}

}  // namespace vox
