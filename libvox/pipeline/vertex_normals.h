#pragma once

#include "libvox/subdivide/level.h"

namespace vox {

class Progress;
class VoxelMeans;

/// Gives the voxels of a surface that was voxelized by its vertices the limit normals at these
/// vertices. Parallel. At free boundaries, a vertex that is not regular gives one normal or none.
/// @param base  in index space
/// @throws LimitError, Cancelled
void addNormalsOfVertices(const SubdivisionLevel& base, Progress& progress, VoxelMeans& means);

}  // namespace vox
