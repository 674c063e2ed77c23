#pragma once

#include "libvox/core/types.h"
#include "libvox/grid/active_voxels.h"
#include "libvox/grid/mark_brick.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace vox {

/// Buffer of one thread in front of an ActiveVoxels. Voxels come in two ways: kernels mark them as
/// bytes in a brick (mark_brick.h), and collect() packs the marked leaves into bits; single voxels
/// go into a cache of 8 x 8 x 8 leaves of bits, addressed by leaf coordinates modulo its size.
/// Finished leaves wait in a list, so that the lock of a page is taken once for many leaves.
///
/// One object per thread. Voxels reach the ActiveVoxels at the latest with flush().
class LeafCache {
 public:
  explicit LeafCache(ActiveVoxels& grid);

  /// The marks of the brick: MarkBrick::kMarks bytes, all 0 after collect().
  std::uint8_t* marks() { return brick_.marks(); }

  /// Switches on the marked voxels and clears the marks.
  /// @param low, high  corners of a box of voxels that fits (MarkBrick::fits); only its leaves may
  ///   have marks
  /// @throws LimitError  the ActiveVoxels exceeds its memory limit
  void collect(const openvdb::Coord& low, const openvdb::Coord& high);

  /// Switches on one voxel.
  /// @throws LimitError  as collect
  void add(const openvdb::Coord& voxel) {
    const auto in = [](std::int32_t v) { return static_cast<unsigned>(v) & 7U; };
    LeafWords& words =
        wordsOf({voxel.x() >> kLeafLog2, voxel.y() >> kLeafLog2, voxel.z() >> kLeafLog2});
    words[in(voxel.x())] |= std::uint64_t{1} << (in(voxel.y()) << 3U | in(voxel.z()));
  }

  /// Switches on the voxels that hold some positions (voxelOf).
  /// @throws LimitError  as collect
  void add(std::span<const Vec3d> positions);

  /// Some positions, coordinate by coordinate. Unused places at the end may hold anything.
  static constexpr std::size_t kPositionsAtOnce = 64;
  struct Positions {
    using Column = std::array<double, kPositionsAtOnce>;
    alignas(64) std::array<Column, 3> axis{};
  };
  /// Switches on the voxels that hold the first `count` positions (voxelOf).
  /// @throws LimitError  as collect
  void add(const Positions& positions, std::size_t count);

  /// Switches on voxels of a block of 4 x 4 x 4: bit 16 i + 4 j + k stands for voxel
  /// origin + (i, j, k). The block may lie across leaves.
  /// @throws LimitError  as collect
  void addBlock(const openvdb::Coord& origin, std::uint64_t voxels);

  /// Sends all voxels to the ActiveVoxels.
  /// @throws LimitError  as collect
  void flush();

  struct VoxelPlaces;

 private:
  static constexpr int kLeafLog2 = MarkBrick::kLeafLog2;
  struct LeafCoord {
    std::int32_t x, y, z;
    bool operator==(const LeafCoord&) const = default;
  };
  static constexpr unsigned kCacheLog2 = 3;
  static constexpr unsigned kCacheMask = (1U << kCacheLog2) - 1;
  static constexpr std::size_t kSlots = std::size_t{1} << (3 * kCacheLog2);
  /// Stands for an empty slot; no voxel has such leaf coordinates.
  static constexpr LeafCoord kNoLeaf = {INT32_MIN, INT32_MIN, INT32_MIN};

  /// The bits of a leaf in the cache. The leaf takes the place of another one with the same slot.
  LeafWords& wordsOf(const LeafCoord& leaf) {
    const unsigned slot = (static_cast<unsigned>(leaf.x) & kCacheMask) << (2 * kCacheLog2) |
                          (static_cast<unsigned>(leaf.y) & kCacheMask) << kCacheLog2 |
                          (static_cast<unsigned>(leaf.z) & kCacheMask);
    if (leaves_[slot] != leaf) [[unlikely]]
      replace(slot, leaf);
    return words_[slot];
  }
  void addPlaces(const VoxelPlaces& places, std::size_t count);
  void replace(std::size_t slot, const LeafCoord& leaf);
  void send(const LeafCoord& leaf, const LeafWords& words);
  void send(const openvdb::Coord& origin, const LeafWords& words);
  void drain();

  ActiveVoxels& grid_;
  MarkBrick brick_;
  std::vector<LeafWords> words_;                 // bits of the leaf in each slot
  std::vector<LeafCoord> leaves_;                // leaf in each slot, or kNoLeaf
  std::vector<ActiveVoxels::PageLeaf> pending_;  // leaves to send to grid_
  struct KnownPage {
    openvdb::Coord origin;
    ActiveVoxels::Page* page = nullptr;
  };
  std::array<KnownPage, 8> pages_;  // last page of each parity of its coordinates
};

}  // namespace vox
