#pragma once

#include "libvox/voxelize/scan.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace vox::detail {

/// Triangles that the vector kernel takes at a time.
inline constexpr std::size_t kScanChunk = 64;

/// In: corners, SoA; out: the blocks. Lanes past the number of triangles are computed but mean
/// nothing.
struct alignas(64) SmallScan {
  std::array<std::array<double, kScanChunk>, 9> corners;  ///< [3 corner + axis][triangle]
  std::array<std::array<double, kScanChunk>, 3> origin;   ///< [axis][triangle], whole numbers
  std::array<std::uint64_t, kScanChunk> voxels;           ///< as VoxelBlock::voxels
  std::array<std::uint64_t, kScanChunk> fits;  ///< 0: too large for a block, or not finite
};

/// Scans the first `count` triangles, on the best vector unit of the processor.
void scanSmall(SmallScan& scan, std::size_t count, Separation separation);

}  // namespace vox::detail
