#pragma once

#include "libvox/core/memory.h"
#include "libvox/core/progress.h"
#include "libvox/mesh/stop_rule.h"
#include "libvox/subdivide/level.h"
#include "libvox/volume/color_sums.h"

#include <optional>
#include <span>

namespace vox {

/// Samples the colours of a prepared surface in index space, given those of its corners, where it
/// was voxelized: at the vertices of vertex conversion, submesh by submesh; or, where it stops at a
/// level, at places on the polygons of that level no more than half a voxel apart. Parallel.
/// @throws LimitError  the polygons of the level do not fit into the budget
/// @throws Cancelled
void sampleColors(const SubdivisionLevel& base, std::span<const Vec3d> cornerColors,
                  const StopRule& until, const MemoryBudget& budget, const Progress& progress,
                  ColorSums& sums);

}  // namespace vox
