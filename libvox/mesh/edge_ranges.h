#pragma once

#include "libvox/core/buckets.h"
#include "libvox/mesh/adjacency.h"

#include <vector>

namespace vox {

/// The corners of a mesh by edge, as cornersByEdge sorts them, one range of lower vertices after
/// the other. Takes less memory, and each range stays in a cache.
class EdgeRanges {
 public:
  explicit EdgeRanges(const PolygonMesh& mesh);

  Index size() const { return runs_.size(); }
  /// Corners of the edges whose lower vertices are in range number `range`. Thread-safe.
  std::vector<EdgeCorner> corners(Index range) const;

 private:
  const PolygonMesh& mesh_;
  Index facesPerRun_;
  Buckets<Index> runs_;  ///< for each range, the runs of faces that have edges in it
};

/// Calls visit(span of EdgeCorner) for each edge of a mesh, once, from any thread.
template <class Visit>
void forEachEdgeInParallel(const PolygonMesh& mesh, Visit&& visit) {
  const EdgeRanges ranges(mesh);
  parallelForEach(ranges.size(), 1, [&](Index range) {
    const std::vector<EdgeCorner> corners = ranges.corners(range);
    forEachEdge(corners, visit);
  });
}

}  // namespace vox
