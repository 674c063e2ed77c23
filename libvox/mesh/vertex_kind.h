#pragma once

#include "libvox/mesh/adjacency.h"

#include <cstdint>
#include <vector>

namespace vox {

/// Kinds of vertices, by how the faces around them are connected.
enum class VertexKind : std::uint8_t {
  kUnused,    ///< no face has it
  kInterior,  ///< one closed one-ring of 3 faces or more: it has a V-face
  kTwoFaces,  ///< one closed one-ring of 2 faces: its V-face would have two corners
  kBoundary,  ///< one open fan
  kBowTie,    ///< several one-rings or fans
};

/// Kind of each vertex. Cost O(C + V); parallel, result independent of thread count.
std::vector<VertexKind> vertexKinds(const PolygonMesh& mesh, const Adjacency& adjacency);

}  // namespace vox
