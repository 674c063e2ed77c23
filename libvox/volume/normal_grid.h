#pragma once

#include "libvox/grid/openvdb_fwd.h"

#include <memory>

namespace vox {

class VoxelMeans;

/// Grid `normal`: at each voxel of the mask the direction of its mean, of length 1; 0 if opposite
/// sides cancel. Background 0. Parallel; result independent of thread count.
/// @param mask   without tiles
/// @param means  of the voxels of the mask, after fillGaps
std::shared_ptr<openvdb::Vec3SGrid> normalGrid(const openvdb::MaskGrid& mask,
                                               const VoxelMeans& means);

}  // namespace vox
