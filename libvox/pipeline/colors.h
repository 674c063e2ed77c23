#pragma once

#include "libvox/core/memory.h"
#include "libvox/core/progress.h"
#include "libvox/grid/openvdb.h"
#include "libvox/grid/transform.h"
#include "libvox/io/scene_file.h"
#include "libvox/volume/texture.h"

#include <Eigen/Geometry>

#include <optional>
#include <span>

namespace vox {

struct PreparedSurface;

/// A solid texture and the way to its space.
struct PlacedTexture {
  SolidTexture texture;
  Eigen::Affine3d fromWorld;
};

/// What an object is coloured with: the texture that is asked for, or else its own, or nothing.
/// @param turn  of the grid
std::optional<PlacedTexture> textureOf(const SceneObject& object,
                                       const std::optional<TextureSpec>& asked, Turn turn);

/// The grid `color`, active at the voxels of the mask. Objects are painted one after the other,
/// each on all its voxels, so that where several share a voxel the last of them has it: with their
/// texture, or the colours of their mesh refined with it, of which each voxel has the mean. What
/// has neither is kPlainColor.
///
/// @param surfaces  their voxels are known; a single one may leave that to the mask
/// @throws LimitError  it does not fit into the budget
/// @throws Cancelled
openvdb::GridBase::Ptr makeColorGrid(const openvdb::MaskGrid& mask,
                                     std::span<const PreparedSurface> surfaces,
                                     MemoryBudget& budget, const Progress& progress);

}  // namespace vox
