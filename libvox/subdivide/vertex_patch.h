#pragma once

#include "libvox/mesh/patch.h"
#include "libvox/subdivide/level.h"

#include <optional>
#include <span>

namespace vox {

/// The regular patch of a vertex of a level >= 1 of which all faces are quads: four, or fewer at a
/// free boundary; else nothing. Boundary points of an extended surface are replaced by the mirror
/// images that make strip faces ordinary ones.
///
/// @param ring    of the vertex
/// @param values  of the points of the level: their positions, or whatever is refined like them
std::optional<Patch> patchAround(const SubdivisionLevel& level, const OneRing& ring,
                                 std::span<const Vec3d> values);

/// L-inf diameter of the largest face around a vertex.
double largestFace(const PolygonMesh& mesh, const Adjacency& adjacency, const OneRing& ring);

}  // namespace vox
