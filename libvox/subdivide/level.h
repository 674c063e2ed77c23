#pragma once

#include "libvox/mesh/adjacency.h"
#include "libvox/mesh/polygon_mesh.h"

#include <vector>

namespace vox {

/// How the next Doo-Sabin step treats boundary edges.
enum class BoundaryStage {
  kPlain,   ///< it ignores them: there are none, or the mesh shrinks from its boundary
  kExtend,  ///< level 0 of an extended mesh: it adds half faces out to the boundary curve
  kStrips,  ///< level >= 1 of an extended mesh: faces with a boundary edge are strip faces
};

/// One level of a subdivided mesh.
struct SubdivisionLevel {
  PolygonMesh mesh;
  Adjacency adjacency;
  BoundaryStage boundary = BoundaryStage::kPlain;
  /// At level 0, if the mesh was cut along creases, per corner: for a boundary edge of a cut the
  /// corner of the edge on the other side, or the corner itself if the edge has no length. All
  /// other corners have kNone. Else empty.
  std::vector<Index> seam = {};

  /// Whether the edge of corner c is an edge of the surface: boundary, and no side of a cut.
  bool isOpen(Index c) const {
    return adjacency.twin[c] == kNone && (seam.empty() || seam[c] == kNone);
  }
};

}  // namespace vox
