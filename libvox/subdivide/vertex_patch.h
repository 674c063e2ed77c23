#pragma once

#include "libvox/mesh/patch.h"
#include "libvox/subdivide/level.h"

#include <optional>
#include <span>

namespace vox {

/// The patch around a vertex of a level >= 1; nothing if the vertex is not regular. It is regular
/// if its faces are quads: four of them, or fewer at a free boundary. Boundary points of an
/// extended surface are replaced by mirror images, so that strip faces become whole quads.
///
/// @param ring    one-ring of the vertex
/// @param values  one per point of the level: the positions, or others refined with their weights
std::optional<Patch> patchAround(const SubdivisionLevel& level, const OneRing& ring,
                                 std::span<const Vec3d> values);

/// L-inf diameter of the largest face around a vertex.
double largestFace(const PolygonMesh& mesh, const Adjacency& adjacency, const OneRing& ring);

}  // namespace vox
