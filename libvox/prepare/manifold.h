#pragma once

#include "libvox/mesh/adjacency.h"
#include "libvox/mesh/polygon_mesh.h"

#include <vector>

namespace vox {

/// The pairs of faces that are joined along edges. Their winding does not matter.
struct Joints {
  /// As Adjacency, but the two corners of a joined edge may run in the same direction.
  Adjacency adjacency;
  /// The lowest corner of each crowded edge (three or more faces), sorted by the vertices of the
  /// edges.
  std::vector<Index> crowdedEdges;
};

/// How crowded edges, those of three or more faces, are treated.
enum class CrowdedEdge {
  kPairSheets,  ///< the faces are joined in pairs that continue each other
  kSeparate,    ///< no faces are joined
};

/// Joins faces along their common edges. Precondition: the vertices of each face are distinct.
///
/// First the two faces of each edge of two faces are joined. A sheet is a set of faces that are
/// joined so far. Then, with kPairSheets, the crowded edges are treated one by one. At each of
/// them, pairs of faces that are not yet joined there are joined in this order:
///  1. faces of one sheet that close it with consistent winding (two cubes that touch along an edge
///     stay two cubes);
///  2. faces of different sheets, the flattest pair first (a fin on a plate leaves the plate
///     whole).
/// A face without a partner ends at the edge. A pair that would make its sheet one-sided is never
/// joined. At an edge of more than 32 faces none are joined. Ties go to the lower faces. The result
/// depends neither on the winding of the input nor on the first corner of a face.
///
/// Cost O(C log C). Parallel but for crowded edges.
Joints joinFaces(const PolygonMesh& mesh, CrowdedEdge crowded);

/// Gives every fan of faces around a vertex a vertex of its own. The fan with the lowest corner
/// keeps the vertex; the others get copies, appended in order of (vertex, lowest corner). Parallel
/// but for the vertices of several fans. Cost O(C log n) for fans of n corners.
///
/// @param joints  corners at a vertex belong to one fan if joined edges connect them
/// @return        for each appended point, the point that it copies
/// @throws LimitError  there would be 2^32 - 1 points or more
std::vector<Index> splitFans(PolygonMesh& mesh, const Adjacency& joints);

}  // namespace vox
