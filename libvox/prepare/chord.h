#pragma once

#include "libvox/mesh/adjacency.h"
#include "libvox/mesh/polygon_mesh.h"

#include <vector>

namespace vox {

/// What chordInteriorPairs did; all numbers are those of its argument.
struct ChordResult {
  PolygonMesh mesh;                       ///< points unchanged, some unused now
  std::vector<Index> faceOrigin;          ///< the argument's face each face was
  std::vector<Index> chordedVertices;     ///< in the order they were removed
  std::vector<Index> collapsedFaces;      ///< left with two corners and closed up, in that order
  std::vector<Index> vanishedComponents;  ///< last face of each component that closed up altogether
};

/// Removes every interior vertex that has only two faces from both of them, which then share one
/// edge instead of two. A face left with two corners is dropped and its neighbours are joined to
/// each other; this goes on until no such vertex is left. Vertices on the boundary stay.
///
/// The mesh has faces of distinct vertices and one fan at each vertex; `joints` as joinFaces makes
/// it. The result may have edges of four faces, where a chord runs beside an edge that was there.
/// Cost O(C).
ChordResult chordInteriorPairs(const PolygonMesh& mesh, const Adjacency& joints);

/// Separates the two faces of every interior vertex that has only two: their edges at the vertex
/// become boundary. The crude alternative to chording, which always ends.
void openInteriorPairs(const PolygonMesh& mesh, Adjacency& joints);

}  // namespace vox
