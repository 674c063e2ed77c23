#pragma once

#include "libvox/mesh/adjacency.h"
#include "libvox/mesh/polygon_mesh.h"

#include <cstdint>
#include <span>
#include <vector>

namespace vox {

/// Partition of the faces of a mesh: each face that is not left out is in exactly one submesh.
struct Partition {
  std::vector<Index> faces;          ///< submesh after submesh
  std::vector<Index> offsets = {0};  ///< submeshes + 1

  Index size() const { return static_cast<Index>(offsets.size() - 1); }
  std::span<const Index> submesh(Index s) const {
    return std::span(faces).subspan(offsets[s], offsets[s + 1] - offsets[s]);
  }
};

/// The largest number of faces around a vertex, or of edges of a face.
Index largestNeighbourhood(const PolygonMesh& mesh);

/// Covers a mesh greedily: a face not yet covered becomes a centre, faces without boundary edge
/// first. It gathers the nearest uncovered faces, breadth-first over edges, up to `most` faces. A
/// group of fewer than half as many faces is added to the submesh before it. Submeshes are compact,
/// because each task also needs the one-ring of its submesh, and the larger the one-ring is, the
/// more work is repeated.
///
/// Blocks of consecutive faces are covered in parallel; no submesh crosses blocks. That costs
/// little if the order of the faces is local, as it usually is. If the cover of a larger mesh falls
/// to pieces, the faces are put into spatial order and covered again. Deterministic; the result
/// does not depend on threads.
///
/// @param most  faces of a submesh, at least 1. It is raised to an eighth of largestNeighbourhood
///   if that is more, because each submesh there needs all these faces.
/// @param leftOut  for each face, whether it needs no cover; empty: all do
/// Cost O(C). Source: paper section 4.
Partition coverGreedily(const PolygonMesh& mesh, const Adjacency& adjacency, Index most,
                        std::span<const std::uint8_t> leftOut = {});

}  // namespace vox
