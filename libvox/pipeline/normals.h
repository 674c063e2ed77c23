#pragma once

#include "libvox/options/surface_options.h"
#include "libvox/pipeline/choose.h"
#include "libvox/subdivide/level.h"

namespace vox {

class Progress;
class VoxelMeans;

/// Adds the normals of a surface to the means of its voxels.
///
/// By vertices: each voxel gets the limit normals at the vertices in it. By polygons: each polygon
/// gives a normal to every voxel whose closed cube it meets, the one at its point nearest to the
/// centre of the voxel; normals are blended over triangles from the limit normals at their corners.
/// Polygons of level 0 are flat and have their own normal. Source: paper section 8.
///
/// @param base  in index space
/// @throws LimitError, Cancelled
void addNormals(const SubdivisionLevel& base, const ConversionWay& way,
                const SurfaceOptions& options, Progress& progress, VoxelMeans& means);

}  // namespace vox
