#pragma once

#include "libvox/core/memory.h"
#include "libvox/core/progress.h"
#include "libvox/subdivide/level.h"

#include <optional>

namespace vox {

/// Triangles and quads that follow the smooth surface of a prepared mesh to within about
/// `tolerance`, with the same winding, from the first level that is fine enough.
///
/// The polygons of a Doo-Sabin level touch the limit surface at their centroids and are farthest
/// from it at their vertices. So every vertex moves halfway to its limit point, the centroid of its
/// V-face. That halves the largest distance, at the same number of polygons. A level is fine enough
/// if no vertex is farther off than the tolerance along the normal, and no quad more twisted. Both
/// fall by a factor of 4 from level to level. Faces of five and more corners become triangles
/// around their centroid.
///
/// @param tolerance  same unit as the mesh, > 0
/// @param budget     for the levels in between
/// @throws LimitError  a level does not fit
/// @throws Cancelled
PolygonMesh limitPolygons(SubdivisionLevel base, double tolerance, const MemoryBudget& budget,
                          const Progress& progress);

/// Some thousands of polygons near the smooth surface, for estimates. If `levels` is set: of that
/// level, or of an earlier one. A mesh of more polygons is returned as it is.
PolygonMesh fewPolygons(const SubdivisionLevel& base, std::optional<int> levels);

}  // namespace vox
