#pragma once

#include "libvox/core/memory.h"
#include "libvox/options/stop_rule.h"
#include "libvox/options/surface_options.h"
#include "libvox/options/voxelize.h"
#include "libvox/pipeline/conversion_report.h"
#include "libvox/subdivide/level.h"

namespace vox {

class Progress;
class ActiveVoxels;

/// Polygon conversion of a prepared surface in index space into a grid: refines polygons to the
/// stop rule (levels = 0: takes those of the base), cuts them into triangles and switches on every
/// voxel that these meet in the sense of `separation` (scan.h). Neighbouring polygons share sides
/// of triangles, so the voxels separate the two sides of the surface. Whole levels are built only
/// for levels = K with Localize::kOff, and of the last one only the points. Parallel; the voxels do
/// not depend on threads or submeshes. Credits the current stage of `progress`.
///
/// @param until   not untilVoxel()
/// @param budget  for the nodes of the grid, and a refined mesh, until this returns
/// @throws LimitError  not enough memory, too many polygons, 2^32 - 1 corners or more, or a
///   triangle beyond the range of the scan
/// @throws Cancelled
void markPolygons(SubdivisionLevel base, const StopRule& until, const SurfaceOptions& options,
                  Separation separation, MemoryBudget budget, Progress& progress,
                  ActiveVoxels& grid, PolygonReport& report);

}  // namespace vox
