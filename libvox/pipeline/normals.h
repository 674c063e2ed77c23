#pragma once

#include "libvox/core/progress.h"
#include "libvox/grid/voxel_means.h"
#include "libvox/pipeline/choose.h"
#include "libvox/subdivide/level.h"

namespace vox {

/// Adds the normals of a surface to the means of its voxels. Every polygon gives its unit normal to
/// all voxels of the mask that it meets (closed cubes). Of quads that is the normal of the smooth
/// surface at their centroid (DESIGN section 5). A surface that became voxels by its vertices gives
/// polygons that fit into a voxel; one that became polygons gives these, so its faces are flat.
///
/// @param base  in index space
/// @throws LimitError, Cancelled
void addNormals(const SubdivisionLevel& base, const ConversionWay& way, Progress& progress,
                VoxelMeans& means);

}  // namespace vox
