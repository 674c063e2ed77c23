#pragma once

#include "libvox/core/memory.h"
#include "libvox/core/progress.h"
#include "libvox/grid/surface_grid.h"
#include "libvox/options/stop_rule.h"
#include "libvox/pipeline/surface.h"
#include "libvox/subdivide/level.h"
#include "libvox/voxelize/scan.h"

#include <cstdint>

namespace vox {

struct PolygonReport {
  std::uint64_t triangles = 0;
  std::uint64_t fanned = 0;  ///< polygons without a proper triangulation (triangulate.h)
  int levels = 0;            ///< Doo-Sabin steps down to the deepest vertex
  Index submeshes = 0;
};

/// Polygon conversion of a prepared surface in index space into a grid: polygons as fine as the
/// rule says (levels = 0: those of the base), then every voxel that they, cut into triangles, meet
/// as `separation` says (scan.h). Neighbouring polygons share sides of triangles, so the voxels
/// separate the two sides of the surface. The refined mesh is never built, except for levels = K
/// with Localize::kOff. Parallel; the voxels do not depend on threads or submeshes. Credits the
/// current stage of `progress`.
///
/// @param until   not untilVoxel()
/// @param budget  for the nodes of the grid, and a refined mesh, until this returns
/// @throws LimitError  not enough memory, too many polygons, 2^32 - 1 corners or more, or a
///   triangle beyond the range of the scan
/// @throws Cancelled
void markPolygons(SubdivisionLevel base, const StopRule& until, const SurfaceOptions& options,
                  Separation separation, MemoryBudget budget, Progress& progress, SurfaceGrid& grid,
                  PolygonReport& report);

}  // namespace vox
