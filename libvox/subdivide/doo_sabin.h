#pragma once

#include "libvox/options/smoothing_options.h"
#include "libvox/subdivide/image_vertices.h"
#include "libvox/subdivide/level.h"

#include <cstdint>
#include <vector>

namespace vox {

/// Level 0.
/// @throws MeshError  the mesh is not an oriented manifold, with or without boundary
SubdivisionLevel baseLevel(PolygonMesh mesh, BoundaryRule rule = BoundaryRule::kExtend);

/// The next level, given its points.
///
/// Its faces are, in this order: one F-face per face (which keeps its corner numbers: corner c of
/// the new mesh has point c), one E-face per interior edge, one V-face per interior vertex. A
/// vertex with two faces has no V-face (it would have two corners): its two E-faces are joined to
/// each other. A bow-tie vertex has one V-face per closed fan. The first level of an extended mesh
/// goes on with one half V-face per open fan, then one half E-face per boundary edge, both in the
/// order of the boundary corners (a fan counts for the boundary edge that leaves it): all its faces
/// on the boundary are strip faces, and stay so. Otherwise corners on boundary edges make F-faces
/// only. Topology is index arithmetic on corners; nothing is hashed or searched. Parallel; result
/// independent of thread count.
///
/// @throws LimitError  the level would have 2^32 - 1 corners or more
/// Source: paper sections 2.1 and 2.3; DESIGN sections 4 and 6.
SubdivisionLevel nextLevel(const SubdivisionLevel& level, std::vector<Vec3d> image);

/// K Doo-Sabin steps.
SubdivisionLevel subdivide(SubdivisionLevel level, int levels);

/// Bound on the corners of the next level, exact for closed meshes without vertices of two faces:
/// F-faces keep C, E-faces add 4 per interior edge, V-faces at most C, half faces 6 per boundary
/// edge.
std::uint64_t nextCornerCount(const SubdivisionLevel& level);

/// Whether c is the corner that stands for its edge (interior, lower corner number).
inline bool leadsEdge(const Adjacency& adjacency, Index c) {
  return adjacency.twin[c] != kNone && c < adjacency.twin[c];
}

/// Valence of the vertex of c if c is the lowest corner of a closed one-ring, else 0. Walks both
/// ways round at once and stops at the first lower corner: O(n log n) for all n corners of a ring.
Index ledOneRingSize(const PolygonMesh& mesh, const Adjacency& adjacency, Index c);

}  // namespace vox
