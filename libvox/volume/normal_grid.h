#pragma once

#include "libvox/grid/voxel_sums.h"

#include <openvdb/openvdb.h>

namespace vox {

/// Grid `normal`: at each voxel of the mask the direction of its sum, of length 1; background 0. A
/// voxel that got nothing takes what its 26 neighbours got, or, if they got nothing either, keeps
/// 0. Parallel; the result does not depend on threads.
openvdb::Vec3SGrid::Ptr normalGrid(const openvdb::MaskGrid& mask, const VoxelSums& sums);

}  // namespace vox
