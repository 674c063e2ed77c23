#pragma once

#include "libvox/options/smoothing_options.h"
#include "libvox/subdivide/image_vertices.h"
#include "libvox/subdivide/level.h"

#include <cstdint>
#include <vector>

namespace vox {

/// The mesh as level 0, with its adjacency.
/// @throws MeshError  the mesh is not an oriented manifold, with or without boundary
SubdivisionLevel baseLevel(PolygonMesh mesh, BoundaryRule rule = BoundaryRule::kExtend);

/// The same for a mesh that is known to be an oriented manifold with this adjacency.
SubdivisionLevel baseLevel(PolygonMesh mesh, Adjacency adjacency,
                           BoundaryRule rule = BoundaryRule::kExtend);

/// The next level.
///
/// Its faces are, in this order: one F-face per face (which keeps its corner numbers: corner c of
/// the new mesh has point c), one E-face per interior edge, one V-face per interior vertex. A
/// vertex with two faces has no V-face (it would have two corners): its two E-faces are joined to
/// each other. A bow-tie vertex has one V-face per closed fan. In the first level of an extended
/// mesh follow one half V-face per open fan, then one half E-face per boundary edge. Both are in
/// the order of the boundary corners (a fan belongs to the boundary edge that leaves it). From then
/// on all faces on the boundary are strip faces. Otherwise corners on boundary edges make F-faces
/// only. Topology is index arithmetic on corners; nothing is hashed or searched. Parallel; result
/// independent of thread count.
///
/// @param image  points of the next level, from imageVertices(level)
/// @throws LimitError  the level would have 2^32 - 1 corners or more
/// Source: paper sections 2.1 and 2.3; DESIGN sections 4 and 6.
SubdivisionLevel nextLevel(const SubdivisionLevel& level, std::vector<Vec3d> image);

/// The level that is `levels` Doo-Sabin steps further.
/// @throws LimitError  as nextLevel
SubdivisionLevel subdivide(SubdivisionLevel level, int levels);

/// Upper bound of the number of corners of the next level; exact for closed meshes without vertices
/// of two faces. F-faces have C corners, E-faces 4 per interior edge, V-faces at most C, half faces
/// 6 per boundary edge.
std::uint64_t nextCornerCount(const SubdivisionLevel& level);

/// Whether c leads its edge: the edge is interior and c the lower of its two corners.
inline bool leadsEdge(const Adjacency& adjacency, Index c) {
  return adjacency.twin[c] != kNone && c < adjacency.twin[c];
}

/// Valence of the vertex of c if c leads a closed one-ring, as its lowest corner; else 0. Walks
/// both ways round at once and stops at the first lower corner, so that all n corners of a one-ring
/// together cost O(n log n).
Index ledOneRingSize(const PolygonMesh& mesh, const Adjacency& adjacency, Index c);

}  // namespace vox
