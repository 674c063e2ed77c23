#pragma once

#include "libvox/grid/voxel_means.h"

#include <openvdb/openvdb.h>

namespace vox {

/// Grid `normal`: at each voxel of the mask the direction of its mean, of length 1; 0 if opposite
/// sides cancel. Background 0. Parallel; result independent of thread count.
/// @param mask   without tiles
/// @param means  of the voxels of the mask, after fillGaps
openvdb::Vec3SGrid::Ptr normalGrid(const openvdb::MaskGrid& mask, const VoxelMeans& means);

}  // namespace vox
