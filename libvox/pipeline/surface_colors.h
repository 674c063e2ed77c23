#pragma once

#include "libvox/core/memory.h"
#include "libvox/core/progress.h"
#include "libvox/grid/voxel_means.h"
#include "libvox/subdivide/level.h"

#include <optional>
#include <span>

namespace vox {

/// Samples the colours of a prepared surface in index space, given those of its corners, where it
/// was voxelized: at the vertices of vertex conversion, submesh by submesh; or, of a surface of
/// polygons, at places on those of a level no more than half a voxel apart. Parallel.
/// @param levels  of the polygons; nothing: vertices
/// @throws LimitError  the polygons of the level do not fit into the budget, or what is made where
/// thousands of faces or edges meet
/// @throws Cancelled
void sampleColors(const SubdivisionLevel& base, std::span<const Vec3d> cornerColors,
                  std::optional<int> levels, const MemoryBudget& budget, const Progress& progress,
                  VoxelMeans& means);

}  // namespace vox
