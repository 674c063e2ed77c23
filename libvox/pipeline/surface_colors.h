#pragma once

#include "libvox/subdivide/level.h"

#include <optional>
#include <span>

namespace vox {

class MemoryBudget;
class Progress;
class VoxelMeans;

/// Samples the colours of a prepared surface in index space at the places where it was voxelized:
/// by vertices, at the vertices, submesh by submesh; by polygons, at points of the polygons of a
/// level that are at most half a voxel apart. Parallel.
/// @param cornerColors  of the corners of the base
/// @param levels        of the polygons; empty: by vertices
/// @throws LimitError  the polygons of the level, or the surface where thousands of faces or edges
///   meet, do not fit into the budget
/// @throws Cancelled
void sampleColors(const SubdivisionLevel& base, std::span<const Vec3d> cornerColors,
                  std::optional<int> levels, const MemoryBudget& budget, const Progress& progress,
                  VoxelMeans& means);

}  // namespace vox
