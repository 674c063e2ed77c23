#pragma once

#include "libvox/grid/voxel_means.h"
#include "libvox/mesh/patch.h"

#include <cstdint>

namespace vox {

/// Binary logarithms of the least and the largest number of columns of a tile of normals. A tile
/// may have any number of rows up to the largest number of columns.
inline constexpr int kLeastNormalLevels = 3;
inline constexpr int kMostNormalLevels = 6;

/// Upper bound of the error of a vertex, in voxels: it is computed in single precision, from
/// coordinates below 64, by seven operations.
inline constexpr double kNormalTileError = 5e-5;

/// Adds the unit limit normals at the 2^rows x 2^columns vertices of a patch to the sums of a
/// MeanBrick, each to the voxel that holds the vertex, and marks these voxels. The direction of a
/// normal is off by at most 1e-5, unless the patch is folded. The same bits on every processor.
/// @param patch  with all four faces; its vertices must fit into a MarkBrick
/// @param marks  of the MeanBrick
/// @param sums   of the MeanBrick
void addNormalTile(const Patch& patch, int rows, int columns, std::uint8_t* marks,
                   VoxelMeans::BrickSum* sums);

}  // namespace vox
