#pragma once

#include "libvox/core/progress.h"
#include "libvox/grid/voxel_means.h"
#include "libvox/subdivide/level.h"

namespace vox {

/// Gives the voxels of a surface that was voxelized by its vertices the limit normals there.
/// Parallel. At free boundaries, vertices that are not regular give no more than one normal.
/// @param base  in index space
/// @throws LimitError, Cancelled
void addNormalsOfVertices(const SubdivisionLevel& base, Progress& progress, VoxelMeans& means);

}  // namespace vox
