#pragma once

#include "libvox/core/progress.h"
#include "libvox/grid/voxel_means.h"
#include "libvox/pipeline/choose.h"
#include "libvox/subdivide/level.h"

namespace vox {

/// Adds the normals of a surface to the means of its voxels: of every polygon to all voxels of the
/// mask that it meets (closed cubes).
///
/// A surface that became polygons gives these, with the exact normals of the smooth surface at
/// their vertices, blended over the triangles: a voxel takes the normal at the point nearest to its
/// centre. Polygons that were not smoothed are the surface, and flat. A surface that became voxels
/// by its vertices gives polygons that fit into a voxel, with their own normals, which at centroids
/// of quads are those of the smooth surface (DESIGN section 5).
///
/// @param base  in index space
/// @throws LimitError, Cancelled
void addNormals(const SubdivisionLevel& base, const ConversionWay& way, Progress& progress,
                VoxelMeans& means);

}  // namespace vox
