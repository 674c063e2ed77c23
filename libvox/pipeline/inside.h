#pragma once

#include "libvox/core/memory.h"
#include "libvox/core/progress.h"
#include "libvox/grid/transform.h"
#include "libvox/mesh/polygon_mesh.h"
#include "libvox/options/volume_options.h"

#include <openvdb/openvdb.h>

#include <span>
#include <string>
#include <vector>

namespace vox {

struct PreparedSurface;

/// Checks an object, of which the inside is wanted, for components that have none. kError refuses
/// them, the others add a warning that says where the first one is open.
/// @throws MeshError
void requireInside(const PreparedSurface& surface, OpenMesh openMesh,
                   const GridTransform& transform, std::vector<std::string>& warnings);

/// The black voxels of all objects and what they enclose together (fill.h), except cavities: what
/// lies inside a component that faces inward, and of no other component. What enclosed voxels
/// belong to is asked of polygons that follow the surfaces within a quarter of a voxel.
/// @throws LimitError
/// @throws Cancelled
openvdb::MaskTree::Ptr solidOf(const openvdb::MaskTree& black,
                               std::span<const PreparedSurface> surfaces,
                               const MemoryBudget& budget, const Progress& progress);

/// Triangles and quads that follow some faces of a surface within the tolerance, or, where it stops
/// at a level, are the polygons of that level.
/// @param faces  whole components
/// @throws LimitError
/// @throws Cancelled
PolygonMesh polygonsOf(const PreparedSurface& surface, const std::vector<Index>& faces,
                       double tolerance, const MemoryBudget& budget, const Progress& progress);

}  // namespace vox
