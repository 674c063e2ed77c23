#pragma once

#include "libvox/grid/openvdb_fwd.h"

#include <memory>

namespace vox {

class VoxelMeans;

/// Grid `normal`: at each voxel of the mask the direction of its mean, of length 1; 0 where
/// opposite sides cancel, and outside. Parallel; the result does not depend on threads.
/// @param mask   all in leaves
/// @param means  their gaps are filled
std::shared_ptr<openvdb::Vec3SGrid> normalGrid(const openvdb::MaskGrid& mask,
                                               const VoxelMeans& means);

}  // namespace vox
