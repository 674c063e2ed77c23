#pragma once

#include "libvox/grid/voxel_means.h"
#include "libvox/mesh/patch.h"

#include <cstdint>

namespace vox {

/// Least and largest number of columns of a tile of normals, as logarithms; rows have no least.
inline constexpr int kLeastNormalLevels = 3;
inline constexpr int kMostNormalLevels = 6;

/// Upper bound on the distance of a vertex, as it is computed here, from the true one, in voxels:
/// single precision, at coordinates below 64, in seven steps.
inline constexpr double kNormalTileError = 5e-5;

/// Adds the unit limit normals at the 2^rows x 2^columns vertices of a patch, each at the voxel
/// that holds its vertex, to the sums of a MeanBrick, and marks these voxels. A direction is off by
/// 1e-5 at most where the patch is not folded. The same bits on every processor.
/// @param patch  complete; its vertices fit into a MarkBrick
void addNormalTile(const Patch& patch, int rows, int columns, std::uint8_t* marks,
                   VoxelMeans::BrickSum* sums);

}  // namespace vox
