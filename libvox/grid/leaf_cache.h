#pragma once

#include "libvox/core/types.h"
#include "libvox/grid/active_voxels.h"
#include "libvox/grid/mark_brick.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace vox {

/// One thread's private way into an ActiveVoxels, in three steps that each save the next one work.
/// Kernels mark voxels as bytes in a brick (mark_brick.h), and collect() packs the leaves that were
/// touched into bits. Single voxels go into a cache of 8 x 8 x 8 leaves of bits, addressed by leaf
/// coordinates modulo its size. Both wait in a list that takes the lock of a page once for many
/// leaves.
///
/// One per thread. What it holds reaches the grid with flush() at the latest.
class LeafCache {
 public:
  explicit LeafCache(ActiveVoxels& grid);

  /// MarkBrick::kMarks bytes, all 0 between calls of collect.
  std::uint8_t* marks() { return brick_.marks(); }

  /// Takes the marks in the leaves of a box of voxels that fits (MarkBrick) and clears them. No
  /// other leaf may be marked.
  /// @throws LimitError  the grid may not grow
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

  /// Some positions, coordinate by coordinate; what lies behind the last of them does not matter.
  static constexpr std::size_t kPositionsAtOnce = 64;
  struct Positions {
    using Column = std::array<double, kPositionsAtOnce>;
    alignas(64) std::array<Column, 3> axis{};
    Vec3d operator[](std::size_t i) const { return {axis[0][i], axis[1][i], axis[2][i]}; }
  };
  /// The same for the first `count` of them.
  void add(const Positions& positions, std::size_t count);

  /// Switches on voxels of the 4 x 4 x 4 block that begins at `origin`, which may lie across
  /// leaves: bit 16 i + 4 j + k stands for voxel origin + (i, j, k).
  /// @throws LimitError  as collect
  void addBlock(const openvdb::Coord& origin, std::uint64_t voxels);

  /// Sends everything to the grid.
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
  /// The leaf of a slot that holds none: no voxel has such coordinates.
  static constexpr LeafCoord kNoLeaf = {INT32_MIN, INT32_MIN, INT32_MIN};

  /// The bits of a leaf.
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
  std::vector<LeafWords> words_;                 // per slot
  std::vector<LeafCoord> leaves_;                // whose they are
  std::vector<ActiveVoxels::PageLeaf> pending_;  // on their way to the grid, to lock pages seldom
  struct KnownPage {
    openvdb::Coord origin;
    ActiveVoxels::Page* page = nullptr;
  };
  std::array<KnownPage, 8> pages_;  // by the parity of their coordinates
};

}  // namespace vox
