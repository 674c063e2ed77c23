#pragma once

#include "libvox/core/types.h"
#include "libvox/subdivide/level.h"

#include <vector>

namespace vox {

/// For each vertex of a level, the unit normal of the limit surface at the limit point of the
/// vertex, outward. That is the centroid of the face that the next step makes of the vertex; the
/// first harmonic of that face spans the tangent plane. The limit point of a vertex of an extended
/// boundary is on the boundary curve.
///
/// Where the limit surface has no normal, at the tip of a cone or where creases meet, and at a free
/// boundary, from which the surface shrinks: the normal of the faces around the vertex by their
/// areas. The z axis if these have none.
///
/// Cost O(C), and the points of the next level. Parallel; result independent of thread count.
/// Source: Doo & Sabin 1978; DESIGN sections 4 and 6.
std::vector<Vec3d> limitNormals(const SubdivisionLevel& level);

}  // namespace vox
