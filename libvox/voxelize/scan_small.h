#pragma once

#include "libvox/voxelize/scan.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace vox::detail {

/// Number of lanes of a SmallScan.
inline constexpr std::size_t kScanChunk = 64;

/// Voxels per side of a block.
inline constexpr int kBlockSide = 4;

/// Largest extent, in voxels along each axis, of triangles that are scanned block by block.
inline constexpr int kSmallAcross = 4 * kBlockSide;

/// Input and output of scanSmall. A lane is a triangle and one of the blocks that cover its
/// bounding box; the first block begins at the first voxel that the box meets along each axis.
/// Arrays are
/// [..][lane].
struct alignas(64) SmallScan {
  using Lanes = std::array<double, kScanChunk>;

  // Input:
  std::array<Lanes, 9> corners;  ///< [3 corner + axis], index space; may be nan or infinite
  std::array<Lanes, 3> offset;   ///< of the block from the first block, in voxels

  // Output:
  std::array<std::uint64_t, kScanChunk> fits;    ///< 0: too large or out of range, no results
  std::array<Lanes, 3> across;                   ///< voxels that the bounding box meets, minus 1
  std::array<Lanes, 3> origin;                   ///< first voxel of the block
  std::array<std::uint64_t, kScanChunk> voxels;  ///< as VoxelBlock::voxels
};

/// Scans the first `count` lanes on the best vector unit of the processor. May write the output of
/// other lanes, too.
void scanSmall(SmallScan& scan, std::size_t count, Separation separation);

}  // namespace vox::detail
