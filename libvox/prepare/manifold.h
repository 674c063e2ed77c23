#pragma once

#include "libvox/mesh/adjacency.h"
#include "libvox/mesh/polygon_mesh.h"

#include <vector>

namespace vox {

/// Which faces are glued to each other along which edges, whatever their winding.
struct Joints {
  /// As Adjacency, but the two corners of a joined edge may run in the same direction.
  Adjacency adjacency;
  /// The lowest corner of each edge of three or more faces, by the vertices of the edge.
  std::vector<Index> crowdedEdges;
};

/// What becomes of an edge of three or more faces.
enum class CrowdedEdge {
  kPairSheets,  ///< its faces are joined in pairs that continue each other
  kSeparate,    ///< all its faces end there
};

/// Joins the faces of a mesh whose faces have distinct vertices. Edges of two faces are joined.
///
/// On a crowded edge with kPairSheets, pairs are joined in this order as long as both faces are
/// free; an odd face ends there:
///  1. faces that already belong to one sheet and would close it with consistent winding (two cubes
///     that touch along an edge stay two cubes);
///  2. faces of different sheets, the flattest pair first: a fin on a plate leaves the plate whole.
/// A pair that would make its sheet one-sided is never joined. The faces of an edge of more than 32
/// all end there: it has no sheets to speak of. Ties go to the lower faces.
/// A sheet is what is joined so far: first over all edges of two faces, then edge by edge.
/// Neither the winding of the input nor the corner a face starts at has any influence.
///
/// Cost O(C log C).
Joints joinFaces(const PolygonMesh& mesh, CrowdedEdge crowded);

/// Gives every fan of faces around a vertex a vertex of its own: the fan with the lowest corner
/// keeps the vertex, the others get copies, appended in order of (vertex, lowest corner). Corners
/// are of one fan when joined edges connect them, as `joints` says.
///
/// @return  for each appended point, the point it copies
/// @throws LimitError  too many points
/// Cost O(C log C) at worst.
std::vector<Index> splitFans(PolygonMesh& mesh, const Adjacency& joints);

}  // namespace vox
