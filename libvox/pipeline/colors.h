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

/// The texture of an object, placed in its space; empty if there is none.
/// @param turn  of the grid
std::optional<PlacedTexture> placedTexture(const std::optional<TextureSpec>& texture,
                                           const SceneObject& object, Turn turn);

/// The grid `color`, active at the voxels of the mask.
///
/// Objects are painted one after the other, each on all its voxels: a voxel of several objects has
/// the colour of the last of them. An object is painted with its texture, else with the colours of
/// its mesh at the point of the surface closest to the middle of the voxel, else with kPlainColor.
///
/// @param surfaces  with their voxels; a single surface may leave them out: it has the whole mask
/// @throws LimitError  the grid does not fit into the budget
/// @throws Cancelled
std::shared_ptr<openvdb::GridBase> makeColorGrid(const openvdb::MaskGrid& mask,
                                                 std::span<const PreparedSurface> surfaces,
                                                 MemoryBudget& budget, Progress& progress);

}  // namespace vox
