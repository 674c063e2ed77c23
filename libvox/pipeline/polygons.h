#pragma once

#include "libvox/core/memory.h"
#include "libvox/core/progress.h"
#include "libvox/grid/surface_grid.h"
#include "libvox/subdivide/level.h"
#include "libvox/voxelize/scan.h"

#include <cstdint>

namespace vox {

struct PolygonReport {
  std::uint64_t triangles = 0;
  std::uint64_t fanned = 0;  ///< polygons without a proper triangulation (triangulate.h)
};

/// Polygon conversion of a prepared surface in index space into a grid: `levels` Doo-Sabin steps of
/// the whole mesh, then every voxel that its polygons, cut into triangles, meet as `separation`
/// says (scan.h). Neighbouring polygons share sides of triangles, so the voxels separate the two
/// sides of the surface. Parallel; the voxels do not depend on the number of threads.
///
/// @param budget  for the refined mesh and the nodes of the grid together, until this returns
/// @throws LimitError  not enough memory, 2^32 - 1 corners or more, or a triangle beyond the range
///   of the scan
/// @throws Cancelled
void markPolygons(SubdivisionLevel base, int levels, Separation separation, MemoryBudget budget,
                  Progress& progress, SurfaceGrid& grid, PolygonReport& report);

}  // namespace vox
