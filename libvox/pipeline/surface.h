#pragma once

#include "libvox/options/surface_options.h"
#include "libvox/pipeline/conversion_report.h"
#include "libvox/subdivide/level.h"

namespace vox {

class MemoryBudget;
class Progress;
class ActiveVoxels;

/// Vertex conversion of a prepared surface in index space into a grid: subdivides each vertex until
/// the faces around it fit into a voxel, and switches on the voxel that holds it. Parallel; the
/// voxels do not depend on the number of threads. Credits the current stage of `progress` with its
/// parts.
///
/// @param budget  memory for the whole meshes of Localize::kOff
/// @throws LimitError  the grid may not grow; Localize::kOff: the whole mesh would be too large
/// @throws Cancelled
void markSurface(const SubdivisionLevel& base, const SurfaceOptions& options,
                 const MemoryBudget& budget, Progress& progress, ActiveVoxels& grid,
                 SurfaceReport& report);

}  // namespace vox
