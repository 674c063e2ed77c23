// Scan of triangles: small ones by the vector kernel, a chunk of blocks at a time; others one by
// one.

#include "libvox/voxelize/scan.h"

#include "libvox/voxelize/block_sink.h"
#include "libvox/voxelize/scan_large.h"
#include "libvox/voxelize/scan_small.h"

#include <Eigen/Geometry>

#include <cmath>
#include <utility>
#include <vector>

namespace vox::detail {
namespace {

/// Collects blocks of triangles and scans them by the vector kernel, a chunk at a time. Triangles
/// that turn out to be too large for the kernel are scanned by scanLarge.
class BlockQueue {
 public:
  BlockQueue(std::span<const Vec3d> points, std::span<const std::array<Index, 3>> triangles,
             Separation separation, BlockSink& sink)
      : points_(points), triangles_(triangles), separation_(separation), sink_(sink) {}

  /// Adds the first block of a triangle. Its other blocks are added when the first one is scanned.
  void add(Index triangle) { add({triangle, {0, 0, 0}}); }

  /// Scans all blocks that are left.
  void flush() {
    while (count_ > 0) scanChunk();
  }

 private:
  struct Block {
    Index triangle;
    std::array<int, 3> offset;  ///< from the first block, in voxels
    bool first() const { return offset == std::array{0, 0, 0}; }
  };

  void add(const Block& block) {
    const auto& triangle = triangles_[block.triangle];
    for (int axis = 0; axis < 3; ++axis) {
      for (int corner = 0; corner < 3; ++corner)
        scan_.corners[3 * corner + axis][count_] = points_[triangle[corner]][axis];
      scan_.offset[axis][count_] = block.offset[axis];
    }
    blocks_[count_] = block;
    if (++count_ == kScanChunk) scanChunk();
  }

  void scanChunk();
  void addOthers(std::size_t lane, std::vector<Block>& others) const;

  std::span<const Vec3d> points_;
  std::span<const std::array<Index, 3>> triangles_;
  Separation separation_;
  BlockSink& sink_;
  std::size_t count_ = 0;
  std::array<Block, kScanChunk> blocks_{};
  SmallScan scan_{};
};

void BlockQueue::scanChunk() {
  const std::size_t count = std::exchange(count_, 0);
  scanSmall(scan_, count, separation_);
  VoxelBlock* const room = sink_.room(kScanChunk);
  std::size_t taken = 0;
  bool rest = false;
  for (std::size_t i = 0; i < count; ++i) {
    VoxelBlock& block = room[taken];
    bool single = true;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      block.origin[axis] = static_cast<std::int32_t>(scan_.origin[axis][i]);
      single &= scan_.across[axis][i] < kBlockSide;
    }
    block.triangle = blocks_[i].triangle;
    block.voxels = scan_.voxels[i];
    taken += scan_.fits[i] != 0 && scan_.voxels[i] != 0;
    rest |= (scan_.fits[i] == 0 || !single) && blocks_[i].first();
  }
  sink_.take(taken);
  if (!rest) return;

  std::vector<Block> others;
  for (std::size_t i = 0; i < count; ++i) {
    if (!blocks_[i].first()) continue;
    if (scan_.fits[i] != 0) {
      addOthers(i, others);
      continue;
    }
    const auto& triangle = triangles_[blocks_[i].triangle];
    const std::array<Vec3d, 3> corners = {points_[triangle[0]], points_[triangle[1]],
                                          points_[triangle[2]]};
    scanLarge(corners, blocks_[i].triangle, separation_, sink_);
  }
  for (const Block& block : others) add(block);  // not first blocks: they add no others
}

/// Appends all blocks of a triangle except the first, and except those that its plane clearly
/// misses.
void BlockQueue::addOthers(std::size_t lane, std::vector<Block>& others) const {
  const auto& triangle = triangles_[blocks_[lane].triangle];
  const Vec3d& corner = points_[triangle[0]];
  const Vec3d normal =
      (points_[triangle[1]] - corner).cross(points_[triangle[2]] - points_[triangle[0]]);
  // Half a block, plus more than snapping and rounding can move the plane.
  const double reach = (0.5 * kBlockSide + 1e-3) * normal.lpNorm<1>() + 1e-2;
  const auto blocksAlong = [&](int axis) {
    return static_cast<int>(scan_.across[axis][lane]) / kBlockSide + 1;
  };
  for (int x = 0; x < blocksAlong(0); ++x)
    for (int y = 0; y < blocksAlong(1); ++y)
      for (int z = 0; z < blocksAlong(2); ++z) {
        const Block block = {blocks_[lane].triangle,
                             {x * kBlockSide, y * kBlockSide, z * kBlockSide}};
        if (block.first()) continue;
        Vec3d centre;
        for (int axis = 0; axis < 3; ++axis)
          centre[axis] = scan_.origin[axis][lane] + block.offset[axis] + 0.5 * (kBlockSide - 1);
        if (std::abs(normal.dot(centre - corner)) <= reach) others.push_back(block);
      }
}

}  // namespace

void scanTriangles(std::span<const Vec3d> points, std::span<const std::array<Index, 3>> triangles,
                   Separation separation, EmitBlocks emit, void* visit) {
  BlockSink sink(emit, visit);
  BlockQueue queue(points, triangles, separation, sink);
  for (std::size_t i = 0; i < triangles.size(); ++i) queue.add(static_cast<Index>(i));
  queue.flush();
  sink.flush();
}

void scanTriangle(std::span<const Vec3d, 3> corners, Separation separation, EmitBlocks emit,
                  void* visit) {
  BlockSink sink(emit, visit);
  scanLarge(corners, 0, separation, sink);
  sink.flush();
}

void scanPart(std::span<const Vec3d, 3> corners, std::int64_t part, Separation separation,
              EmitBlocks emit, void* visit) {
  BlockSink sink(emit, visit);
  scanLargePart(corners, part, separation, sink);
  sink.flush();
}

}  // namespace vox::detail

namespace vox {

std::int64_t scanPartCount(std::span<const Vec3d, 3> corners) {
  return detail::largePartCount(corners);
}

}  // namespace vox
