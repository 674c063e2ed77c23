#pragma once

#include "libvox/grid/openvdb_fwd.h"
#include "libvox/grid/transform.h"
#include "libvox/mesh/polygon_mesh.h"
#include "libvox/options/volume_options.h"
#include "libvox/pipeline/prepared_surface.h"

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace vox {

class MemoryBudget;
class Progress;

/// Looks for components of an object that have no inside. If there are any: kError refuses the
/// object, other values of `openMesh` add a warning that says where the first of them is open.
/// @throws MeshError
void requireInside(const PreparedSurface& surface, OpenMesh openMesh,
                   const GridTransform& transform, std::vector<std::string>& warnings);

/// The active voxels of all objects and the voxels that they enclose together (fill.h), except
/// cavities. A cavity is an enclosed space inside a component that faces inward, and inside no
/// other component. Polygons that follow the surfaces within a quarter of a voxel decide which
/// spaces are cavities.
/// @throws LimitError
/// @throws Cancelled
std::shared_ptr<openvdb::MaskTree> solidOf(const openvdb::MaskTree& active,
                                           std::span<const PreparedSurface> surfaces,
                                           const MemoryBudget& budget, const Progress& progress);

/// The polygons at which a surface stops (levelOf), cut into triangles.
/// @param faces  ascending, whole components
/// @throws LimitError
/// @throws Cancelled
PolygonMesh trianglesOfLevel(const PreparedSurface& surface, const std::vector<Index>& faces,
                             const MemoryBudget& budget, const Progress& progress);

}  // namespace vox
