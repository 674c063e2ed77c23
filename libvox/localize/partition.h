#pragma once

#include "libvox/mesh/adjacency.h"
#include "libvox/mesh/polygon_mesh.h"

#include <span>
#include <vector>

namespace vox {

/// The faces of a mesh, dealt out to submeshes: each face in exactly one.
struct Partition {
  std::vector<Index> faces;          ///< submesh after submesh
  std::vector<Index> offsets = {0};  ///< submeshes + 1

  Index size() const { return static_cast<Index>(offsets.size() - 1); }
  std::span<const Index> submesh(Index s) const {
    return std::span(faces).subspan(offsets[s], offsets[s + 1] - offsets[s]);
  }
};

/// The most faces around a vertex, or edges of a face.
Index largestNeighbourhood(const PolygonMesh& mesh);

/// Covers a mesh greedily: a face not yet covered becomes a centre, faces without boundary edge
/// first, and gathers the nearest uncovered faces, breadth-first over edges, up to `most` faces.
/// What a submesh needs besides is its one-ring, so compact submeshes repeat little. Remains of
/// fewer than half as many faces are put together with the submesh before them.
///
/// Works on blocks of consecutive faces in parallel, which submeshes do not cross: the input's
/// order is mostly local, and then little is lost. Where it is not, as the cover of a larger mesh
/// falling to pieces shows, the faces are put into spatial order and covered again. Deterministic;
/// the result does not depend on threads.
///
/// @param most  faces of a submesh, at least 1; more where thousands meet, as each submesh there
/// needs them all: an eighth of the largest neighbourhood
/// Cost O(C). Source: paper section 4.
Partition coverGreedily(const PolygonMesh& mesh, const Adjacency& adjacency, Index most);

}  // namespace vox
