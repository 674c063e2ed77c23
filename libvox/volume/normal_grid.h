#pragma once

#include "libvox/grid/openvdb.h"
#include "libvox/grid/voxel_means.h"

namespace vox {

/// Grid `normal`: at each voxel of the mask the direction of its mean, of length 1; 0 where
/// opposite sides cancel, and outside. Parallel; the result does not depend on threads.
/// @param mask   all in leaves
/// @param means  their gaps are filled
openvdb::Vec3SGrid::Ptr normalGrid(const openvdb::MaskGrid& mask, const VoxelMeans& means);

}  // namespace vox
