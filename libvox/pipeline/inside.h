#pragma once

#include "libvox/grid/openvdb_fwd.h"
#include "libvox/grid/transform.h"
#include "libvox/mesh/polygon_mesh.h"
#include "libvox/options/volume_options.h"
#include "libvox/pipeline/prepared_surface.h"
#include "libvox/volume/close.h"

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace vox {

class MemoryBudget;
class Progress;

/// Sets `noInside` of an object, if it has components without an inside. Unless openings are to be
/// closed, kError then refuses the object, and other values of `openMesh` add a warning.
/// @param describeGaps  called if such a component is open; what it says is added to `noInside`
/// @throws MeshError
void requireInside(PreparedSurface& surface, const VolumeSettings& settings,
                   const GridTransform& transform, const std::function<std::string()>& describeGaps,
                   std::vector<std::string>& warnings);

/// The inside of all objects.
struct Solid {
  std::shared_ptr<openvdb::MaskTree> voxels;  ///< those of the surfaces, and what they enclose
  Closure closure = {};                       ///< part of `voxels`
};

/// The active voxels of all objects and the voxels that they enclose together (fill.h), except
/// cavities. If a component has no inside, openings are closed first (close.h); a line of
/// `warnings` says what was closed, and those that stay open are refused or get a warning. A cavity
/// is an enclosed space inside a component that faces inward, and inside no other component.
/// Polygons that follow the surfaces within a quarter of a voxel decide which spaces are cavities.
/// @throws MeshError   as requireInside
/// @throws LimitError
/// @throws Cancelled
Solid solidOf(const openvdb::MaskTree& active, std::span<const PreparedSurface> surfaces,
              const VolumeSettings& settings, const MemoryBudget& budget, Progress& progress,
              std::vector<std::string>& warnings);

/// Triangles that follow some faces of a surface; the polygons themselves where it stops at a
/// level.
/// @param faces      ascending, whole components
/// @param tolerance  voxels
/// @throws LimitError
/// @throws Cancelled
PolygonMesh trianglesNear(const PreparedSurface& surface, const std::vector<Index>& faces,
                          double tolerance, const MemoryBudget& budget, const Progress& progress);

/// The polygons at which a surface stops (levelOf), cut into triangles.
/// @param faces  ascending, whole components
/// @throws LimitError
/// @throws Cancelled
PolygonMesh trianglesOfLevel(const PreparedSurface& surface, const std::vector<Index>& faces,
                             const MemoryBudget& budget, const Progress& progress);

}  // namespace vox
