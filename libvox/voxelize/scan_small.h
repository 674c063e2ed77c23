#pragma once

#include "libvox/voxelize/scan.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace vox::detail {

/// Blocks that the vector kernel takes at a time.
inline constexpr std::size_t kScanChunk = 64;

/// Voxels per side of a block.
inline constexpr int kBlockSide = 4;

/// Triangles up to so many voxels across, along each axis, are scanned block by block.
inline constexpr int kSmallAcross = 4 * kBlockSide;

/// A lane is a triangle and one of the blocks of its bounding box, which begins at the first voxel
/// that the bounding box meets along each axis. Arrays are [..][lane].
struct alignas(64) SmallScan {
  using Lanes = std::array<double, kScanChunk>;

  std::array<Lanes, 9> corners;  ///< in: [3 corner + axis], finite or not
  std::array<Lanes, 3> offset;   ///< in: from the first block, voxels

  std::array<std::uint64_t, kScanChunk> fits;    ///< 0: too large or out of range; no results then
  std::array<Lanes, 3> across;                   ///< voxels that the bounding box meets, less one
  std::array<Lanes, 3> origin;                   ///< of the block
  std::array<std::uint64_t, kScanChunk> voxels;  ///< as VoxelBlock::voxels
};

/// Scans the first `count` lanes, on the best vector unit of the processor. (Others may be scanned
/// too.)
void scanSmall(SmallScan& scan, std::size_t count, Separation separation);

}  // namespace vox::detail
