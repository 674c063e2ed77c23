#pragma once

#include "libvox/grid/openvdb_fwd.h"
#include "libvox/grid/transform.h"
#include "libvox/io/scene_file.h"
#include "libvox/pipeline/prepared_surface.h"

#include <memory>
#include <optional>
#include <span>

namespace vox {

class MemoryBudget;
class Progress;

/// The solid texture of an object, placed in its space; empty if there is none.
/// @param turn  of the grid
std::optional<PlacedTexture> placedTexture(const std::optional<TextureSpec>& texture,
                                           const SceneObject& object, Turn turn);

/// Switches off the voxels of a surface whose foot is transparent: images and materials cover less
/// than half there.
/// @throws LimitError
/// @throws Cancelled
void cutTransparent(openvdb::MaskTree& voxels, const PreparedSurface& surface,
                    const MemoryBudget& budget, Progress& progress);

/// The grid `color`, active at the voxels of the mask; with a soft density, at its voxels near the
/// surface and one more on all sides, so that programs which blend neighbours find a colour
/// wherever there is density.
///
/// Objects are painted one after the other, each on all its voxels: a voxel of several objects has
/// the colour of the last of them. An object is painted with its solid texture, else with
/// the colours of its images, mesh or materials (SurfaceColors) at the point of the surface closest
/// to the middle of the voxel, else with kPlainColor.
/// Voxels outside the mask have the colour of the object to which they are closest.
///
/// @param soft      the voxels of a soft density near the surface (softVoxels); null if there is
/// none
/// @param surfaces  with their voxels; a single surface may leave them out: it has the whole mask
/// @throws LimitError  the grid does not fit into the budget
/// @throws Cancelled
std::shared_ptr<openvdb::GridBase> makeColorGrid(const openvdb::MaskGrid& mask,
                                                 const openvdb::MaskGrid* soft,
                                                 std::span<const PreparedSurface> surfaces,
                                                 MemoryBudget& budget, Progress& progress);

}  // namespace vox
