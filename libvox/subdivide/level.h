#pragma once

#include "libvox/mesh/adjacency.h"
#include "libvox/mesh/polygon_mesh.h"

namespace vox {

/// What the next Doo-Sabin step does at boundary edges.
enum class BoundaryStage {
  kPlain,   ///< nothing: there are none, or the mesh may shrink from them
  kExtend,  ///< level 0: it adds half faces along them, out to the boundary curve
  kStrips,  ///< level >= 1: faces with a boundary edge are strip faces
};

/// One level of a subdivided mesh.
struct SubdivisionLevel {
  PolygonMesh mesh;
  Adjacency adjacency;
  BoundaryStage boundary = BoundaryStage::kPlain;
};

}  // namespace vox
