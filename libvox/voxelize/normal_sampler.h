#pragma once

#include "libvox/grid/mean_brick.h"
#include "libvox/mesh/patch.h"

namespace vox {

/// Gives voxels the limit normals at the vertices that lie in them. One per thread; the sums do not
/// depend on who gets which patch. Source: paper section 8.
class NormalSampler {
 public:
  explicit NormalSampler(VoxelMeans& means) : brick_(means) {}

  /// What a regular vertex has become: 2^rows x 2^columns vertices.
  /// @param patch  complete
  void patch(const Patch& patch, int rows, int columns);

  /// A single vertex.
  /// @param normal  of length 1, or 0: none
  void point(const Vec3d& position, const Vec3d& normal);

 private:
  void each(const Patch& patch, int rows, int columns);

  MeanBrick brick_;
};

}  // namespace vox
