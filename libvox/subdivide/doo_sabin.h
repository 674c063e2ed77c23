#pragma once

#include "libvox/mesh/adjacency.h"
#include "libvox/mesh/polygon_mesh.h"

#include <cstdint>
#include <vector>

namespace vox {

/// One level of a subdivided mesh.
struct SubdivisionLevel {
  PolygonMesh mesh;
  Adjacency adjacency;
};

/// Level 0.
/// @throws MeshError  the mesh is not an oriented manifold, with or without boundary
SubdivisionLevel baseLevel(PolygonMesh mesh);

/// Image vertices of one Doo-Sabin step: one per corner, in corner order. They are the points of
/// the next level. Cost O(C): the weights are a multiple of the identity, the centroid and one
/// cosine, so a face of n corners needs two sums, not n^2 products. Parallel.
/// Source: Doo & Sabin 1978; paper section 2.1, eq. (1).
std::vector<Vec3d> imageVertices(const PolygonMesh& mesh);

/// The next level, given its points.
///
/// Its faces are, in this order: one F-face per face (which keeps its corner numbers: corner c of
/// the new mesh has point c), one E-face per interior edge, one V-face per interior vertex. Corners
/// on boundary edges make F-faces only, so an open mesh shrinks from its boundary. A vertex with
/// two faces has no V-face (it would have two corners): its two E-faces are joined to each other. A
/// bow-tie vertex has one V-face per closed fan. Topology is index arithmetic on corners; nothing
/// is hashed or searched. Parallel; result independent of thread count.
///
/// @throws LimitError  the level would have 2^32 - 1 corners or more
/// Source: paper section 2.1; DESIGN section 5.
SubdivisionLevel nextLevel(const SubdivisionLevel& level, std::vector<Vec3d> image);

/// K Doo-Sabin steps.
SubdivisionLevel subdivide(SubdivisionLevel level, int levels);

/// Bound on the corners of the next level, exact for closed meshes without vertices of two faces:
/// F-faces keep C, E-faces add 4 per interior edge, V-faces at most C.
std::uint64_t nextCornerCount(const SubdivisionLevel& level);

/// Whether c is the corner that stands for its edge (interior, lower corner number).
inline bool leadsEdge(const Adjacency& adjacency, Index c) {
  return adjacency.twin[c] != kNone && c < adjacency.twin[c];
}

/// Valence of the vertex of c if c is the lowest corner of a closed one-ring, else 0. Walks both
/// ways round at once and stops at the first lower corner: O(n log n) for all n corners of a ring.
Index ledRingSize(const PolygonMesh& mesh, const Adjacency& adjacency, Index c);

}  // namespace vox
