#pragma once

#include "libvox/grid/mean_brick.h"
#include "libvox/mesh/patch.h"

namespace vox {

/// Adds the limit normals at vertices to the voxels that hold the vertices. One object per thread;
/// the sums do not depend on the order of patches or on threads. Source: paper section 8.
class NormalSampler {
 public:
  explicit NormalSampler(VoxelMeans& means) : brick_(means) {}

  /// Adds the normals at the 2^rows x 2^columns descendants of a regular vertex.
  /// @param patch  with all four faces
  void patch(const Patch& patch, int rows, int columns);

  /// Adds the normal at a single vertex.
  /// @param normal  of length 1; ignored if 0
  void point(const Vec3d& position, const Vec3d& normal);

 private:
  void each(const Patch& patch, int rows, int columns);

  MeanBrick brick_;
};

}  // namespace vox
