#pragma once

#include "libvox/mesh/patch.h"
#include "libvox/subdivide/local_vertices.h"
#include "libvox/subdivide/split_batch.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vox {

/// Subdivides submeshes of a base mesh, each vertex only until it is fine enough (stop.h). A
/// refined mesh is never built: a regular vertex goes to the sink as a patch, and the irregular
/// vertices around an extraordinary face or vertex are subdivided level by level (Descent).
///
/// A face owns its corners. A corner owns the level-1 vertex that it makes and all descendants of
/// this vertex; at an extended boundary also the boundary points of its edge. So if submeshes cover
/// the mesh once, every vertex is emitted exactly once, and its bits do not depend on the
/// partition.
///
/// One object per thread. Source: paper section 4; DESIGN section 7.
class LocalSurface {
 public:
  /// @param base  level 0, in index space: an oriented manifold with one fan of faces at each
  /// vertex
  explicit LocalSurface(const SubdivisionLevel& base) : vertices_(base) {}

  /// Gives the sink all vertices that the corners of some faces own, each at its own level.
  /// @param faces  of the base
  /// @throws LimitError  coordinates are out of range
  void emit(std::span<const Index> faces, SurfaceSink& sink);

  /// Leaves out what the corners at some vertices of the base own.
  /// @param vertices  for each vertex of the base, whether it is left out; must outlive this object
  void leaveOut(std::span<const std::uint8_t> vertices) { leftOut_ = vertices; }

 private:
  class FineVertices;

  void emitFace(const SubmeshCorner& first, FineVertices& fine);
  void addToBatch(const SubmeshCorner& at, const LevelOneVertex& vertex, FineVertices& fine);
  void splitBatch(FineVertices& fine);
  double diameterAround(const SubmeshCorner& corner, double faceDiameter) const;
  bool isInside(const SubmeshCorner& corner) const;
  void emitBoundary(const SubmeshCorner& first, SurfaceSink& sink);

  LocalVertices vertices_;
  std::span<const std::uint8_t> leftOut_;
  std::vector<std::vector<Vec3d>> finished_;  // vertices that are fine enough, by level
  SplitBatch batch_;                          // vertices that are not
  std::array<SubmeshCorner, SplitBatch::kLanes> corners_;  // of the batch
  std::size_t inBatch_ = 0;
  SplitVertices split_;
};

}  // namespace vox
