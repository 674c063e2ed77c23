#pragma once

#include "libvox/grid/active_voxels.h"
#include "libvox/grid/leaf_cache.h"
#include "libvox/mesh/patch.h"
#include "libvox/voxelize/level_counts.h"

#include <cstdint>

namespace vox {

/// Vertex conversion: switches on the voxels that hold the vertices of a surface.
///
/// Why there are no tunnels. Rounding moves the corners of a triangle of L-inf diameter <= 1 to
/// corners of one unit cube. If all faces are that small, consider the rounded surface, which is at
/// most 1/2 (L-inf) from the surface. It meets a step between neighbouring voxel centres only at
/// active voxels. So no path of inactive voxels, face to face, crosses it: the active voxels
/// 6-separate its sides. (A single step may cross the surface itself, into a pocket that leads
/// nowhere.)
///
/// One object per thread; the voxels do not depend on the distribution of patches to threads.
/// Positions are exact up to kTileError (tile.h). Source: paper section 5, with the criterion of
/// DESIGN section 9.
class VertexSink : public SurfaceSink {
 public:
  explicit VertexSink(ActiveVoxels& grid) : cache_(grid) {}

  void points(std::span<const Vec3d> points, int level) override;
  void patch(const Patch& patch, int k, int level) override;
  void curve(const CurvePoints& points, int k, int level) override;

  /// Sends all voxels to the grid.
  /// @throws LimitError  the grid exceeds its memory limit; points, patch and curve may throw it,
  /// too
  void flush() { cache_.flush(); }

  /// Number of vertices so far, by level.
  const LevelCounts& vertices() const { return vertices_; }

 private:
  void mark(const Vec3d& position);
  std::uint64_t markFewQuadrants(const Patch& patch, int k);
  void markWhole(const Patch& patch, int k);
  void markSmall(const Patch& patch, int k);

  LeafCache cache_;
  LevelCounts vertices_{};
};

}  // namespace vox
