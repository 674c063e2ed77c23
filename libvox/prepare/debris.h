#pragma once

#include "libvox/mesh/polygon_mesh.h"
#include "libvox/options/component_limit.h"
#include "libvox/prepare/repair.h"

#include <string>
#include <vector>

namespace vox {

/// What withoutDebris dropped, and what the largest components are.
struct DebrisReport {
  Index components = 0;  ///< of the mesh
  Index dropped = 0;     ///< components
  Index droppedFaces = 0;
  Index mostFaces = 0;                ///< of a component
  double largestDiagonal = 0;         ///< of the box of a component
  std::vector<Index> keptFaces = {};  ///< faces of the input that are left; empty if all are
};

/// "dropped 12 components of 48 faces"; empty if nothing was dropped.
std::string summary(const DebrisReport& report);

/// The mesh without the components that are below the limits. Components are faces that are joined
/// through edges, once the mesh is repaired with these options; their boxes are those of the input
/// positions. All points stay, and so do the colours of what is left, which may be nothing; groups
/// and attributes do not.
/// @throws MeshError, UsageError, LimitError  as repair
PolygonMesh withoutDebris(const PolygonMesh& mesh, const ComponentLimit& limit,
                          const RepairOptions& options, DebrisReport& report);

}  // namespace vox
