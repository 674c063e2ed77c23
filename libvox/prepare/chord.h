#pragma once

#include "libvox/mesh/adjacency.h"
#include "libvox/mesh/polygon_mesh.h"

#include <vector>

namespace vox {

/// Result of chordInteriorPairs. Faces and vertices are numbered as in its argument.
struct ChordResult {
  PolygonMesh mesh;                       ///< all points of the argument; some are unused now
  std::vector<Index> faceOrigin;          ///< for each face of `mesh`, the face of the argument
  std::vector<Index> chordedVertices;     ///< in the order in which they were removed
  std::vector<Index> collapsedFaces;      ///< dropped with two corners left, in order
  std::vector<Index> vanishedComponents;  ///< last face of each component without any face left
};

/// Whether there is an interior vertex of two faces. Parallel. Arguments as chordInteriorPairs.
bool hasInteriorPair(const PolygonMesh& mesh, const Adjacency& joints);

/// Removes every interior vertex of two faces from both faces, so that these share one edge instead
/// of two. Drops a face with two corners left and joins its neighbours to each other. Repeats this
/// until no such vertex is left. Vertices on the boundary stay.
///
/// The result may have edges of four faces, if a new edge runs beside an old one.
/// @param mesh    faces of distinct vertices, one fan at each vertex
/// @param joints  from joinFaces
/// Cost O(C).
ChordResult chordInteriorPairs(const PolygonMesh& mesh, const Adjacency& joints);

/// Separates the two faces of every interior vertex of two faces: the edges at the vertex become
/// boundary. A crude alternative to chording that needs no repetition.
void openInteriorPairs(const PolygonMesh& mesh, Adjacency& joints);

}  // namespace vox
