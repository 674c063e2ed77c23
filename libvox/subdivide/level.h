#pragma once

#include "libvox/mesh/adjacency.h"
#include "libvox/mesh/polygon_mesh.h"

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
};

}  // namespace vox
