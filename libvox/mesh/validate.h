#pragma once

#include "libvox/mesh/adjacency.h"
#include "libvox/mesh/polygon_mesh.h"

#include <string>
#include <vector>

namespace vox {

/// Kinds of defects of a mesh whose indices are in range.
enum class DefectKind {
  kRepeatedCorner,       ///< a face names the same vertex twice
  kNonManifoldEdge,      ///< an edge has three or more faces
  kInconsistentWinding,  ///< two faces run through their edge in the same direction
  kBowTieVertex,         ///< the faces around a vertex form more than one fan
  kUnusedVertex,         ///< no face has the vertex
};

struct Defect {
  DefectKind kind;
  Index element;        ///< face for kRepeatedCorner, corner for edge defects, else vertex
  std::string message;  ///< names the elements with 0-based numbers: "edge (3, 7) has 4 faces: ..."
};

/// Short name for messages and JSON: "non-manifold edge".
std::string defectName(DefectKind kind);

/// Every defect of a mesh, by kind, then by element. At most `mostPerKind` of a kind have a
/// message; the messages of the others are empty. Cost O(C log C).
std::vector<Defect> findDefects(const PolygonMesh& mesh, const Adjacency& adjacency,
                                std::size_t mostPerKind = 8);

/// Checks the arrays: offsets ascend and cover the corners, every face has 3 corners or more, every
/// index is in range, every coordinate is finite, there is one colour per point or face, or none.
/// @throws MeshError  names the first element that breaks a rule
void requireValidArrays(const PolygonMesh& mesh);

/// Checks that the mesh can be subdivided: an oriented manifold, with or without boundary. Bow-tie
/// vertices and unused vertices are harmless (each fan has its own V-face) and pass.
/// @throws MeshError  names the first offending element and says how many more there are
void requireManifold(const PolygonMesh& mesh, const Adjacency& adjacency);

}  // namespace vox
