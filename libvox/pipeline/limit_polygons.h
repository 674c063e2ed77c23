#pragma once

#include "libvox/core/memory.h"
#include "libvox/core/progress.h"
#include "libvox/subdivide/level.h"

#include <optional>

namespace vox {

/// Triangles and quads that follow the smooth surface of a prepared mesh to within about
/// `tolerance`, wound as it is, in as few levels as that takes.
///
/// The polygons of a Doo-Sabin level touch the limit surface at their centroids and stand off at
/// their vertices, by twice as much as they would if spread evenly. So every vertex goes halfway to
/// its limit point, the centroid of its V-face: the largest error is half that of the polygons
/// themselves, or of a mesh of centroids, at the same number of polygons. A level will do if no
/// vertex is farther off than the tolerance along the normal, and no quad more twisted; both fall
/// by 4 from level to level. Faces of five and more corners become triangles around their centroid.
///
/// @param tolerance  same unit as the mesh, > 0
/// @param budget     for the levels on the way
/// @throws LimitError  a level does not fit
/// @throws Cancelled
PolygonMesh limitPolygons(SubdivisionLevel base, double tolerance, const MemoryBudget& budget,
                          const Progress& progress);

/// Some thousands of polygons near the smooth surface, or near those of level `levels`: to measure,
/// not to convert. A mesh of more polygons than that stays as it is.
PolygonMesh fewPolygons(const SubdivisionLevel& base, std::optional<int> levels);

}  // namespace vox
