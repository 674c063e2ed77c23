#pragma once

#include "libvox/core/progress.h"
#include "libvox/grid/voxel_means.h"
#include "libvox/pipeline/choose.h"
#include "libvox/subdivide/level.h"

namespace vox {

/// Adds the normals of a surface to the means of its voxels.
///
/// A surface that became voxels by its vertices gives each voxel the limit normals at the vertices
/// in it. One that became polygons gives these to all voxels of the mask that they meet (closed
/// cubes), with the limit normals at their vertices, blended over the triangles: a voxel takes the
/// normal at the point nearest to its centre. Polygons that were not smoothed are the surface, and
/// flat. Source: paper section 8.
///
/// @param base  in index space
/// @throws LimitError, Cancelled
void addNormals(const SubdivisionLevel& base, const ConversionWay& way, Progress& progress,
                VoxelMeans& means);

}  // namespace vox
