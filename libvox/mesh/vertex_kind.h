#pragma once

#include "libvox/mesh/adjacency.h"

#include <cstdint>
#include <vector>

namespace vox {

/// How the faces around a vertex hang together.
enum class VertexKind : std::uint8_t {
  kUnused,    ///< no face names it
  kInterior,  ///< one closed ring of 3 faces or more: it has a V-face
  kTwoFaces,  ///< one closed ring of 2 faces: its V-face would have two corners
  kBoundary,  ///< one open fan
  kBowTie,    ///< several rings or fans
};

/// Kind of each vertex. Cost O(C + V); parallel, result independent of thread count.
std::vector<VertexKind> vertexKinds(const PolygonMesh& mesh, const Adjacency& adjacency);

}  // namespace vox
