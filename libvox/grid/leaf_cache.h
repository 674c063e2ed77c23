#pragma once

#include "libvox/grid/surface_grid.h"

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

namespace vox {

/// One thread's private way into a SurfaceGrid. Kernels mark voxels as bytes in a brick of 4 x 4 x
/// 4 leaves, which lives in the first-level cache; collect() packs the leaves that were touched
/// into bits, of which the cache keeps 8 x 8 x 8 leaves; what must leave that goes to the grid.
/// Both are addressed by leaf coordinates modulo their size, so they lie wherever their leaves are.
///
/// Mark index of a voxel: bits 0-2 z, 3-5 y, 6-8 x (within the leaf, OpenVDB's order), 9-10 z,
/// 11-12 y, 13-14 x (of the leaf).
///
/// One per thread. What it holds reaches the grid with flush() at the latest.
class LeafCache {
 public:
  static constexpr int kLeafLog2 = 3;
  static constexpr int kBrickLog2 = 2;                        ///< leaves along a side of the brick
  static constexpr int kBrickSide = 1 << kBrickLog2;          ///< 4
  static constexpr int kVoxelSide = kBrickSide << kLeafLog2;  ///< 32
  static constexpr std::size_t kMarks = std::size_t{1} << (3 * (kLeafLog2 + kBrickLog2));
  static constexpr std::uint8_t kMarked = 0xFF;

  explicit LeafCache(SurfaceGrid& grid);

  /// kMarks bytes, all 0 between calls of collect.
  std::uint8_t* marks() { return marks_.get(); }

  /// Takes the marks in the leaves of a box of voxels, at most kBrickSide leaves along each axis,
  /// and clears them. No other leaf may be marked.
  /// @throws LimitError  the grid may not grow
  void collect(const openvdb::Coord& low, const openvdb::Coord& high);

  /// Switches on one voxel.
  /// @throws LimitError  as collect
  void add(const openvdb::Coord& voxel) {
    const auto in = [](std::int32_t v) { return static_cast<unsigned>(v) & 7U; };
    LeafWords& words =
        wordsOf(voxel.x() >> kLeafLog2, voxel.y() >> kLeafLog2, voxel.z() >> kLeafLog2);
    words[in(voxel.x())] |= std::uint64_t{1} << (in(voxel.y()) << 3U | in(voxel.z()));
  }

  /// Switches on voxels of the 4 x 4 x 4 block that begins at `origin`, which may lie across
  /// leaves: bit 16 i + 4 j + k stands for voxel origin + (i, j, k).
  /// @throws LimitError  as collect
  void addBlock(const openvdb::Coord& origin, std::uint64_t voxels);

  /// Sends everything to the grid.
  void flush();

 private:
  struct FreeMarks {
    void operator()(std::uint8_t* marks) const;
  };
  using LeafCoord = std::array<std::int32_t, 3>;
  struct Entry {
    alignas(64) LeafWords words{};
    LeafCoord leaf{};
    bool used = false;
  };
  static constexpr unsigned kCacheLog2 = 3;
  static constexpr unsigned kCacheMask = (1U << kCacheLog2) - 1;

  /// The bits of a leaf, given by its leaf coordinates.
  LeafWords& wordsOf(std::int32_t x, std::int32_t y, std::int32_t z) {
    const unsigned slot = (static_cast<unsigned>(x) & kCacheMask) << (2 * kCacheLog2) |
                          (static_cast<unsigned>(y) & kCacheMask) << kCacheLog2 |
                          (static_cast<unsigned>(z) & kCacheMask);
    Entry& entry = entries_[slot];
    if (!entry.used || entry.leaf[0] != x || entry.leaf[1] != y || entry.leaf[2] != z) [[unlikely]]
      replace(entry, x, y, z);
    return entry.words;
  }
  void replace(Entry& entry, std::int32_t x, std::int32_t y, std::int32_t z);
  void send(const Entry& entry);

  SurfaceGrid& grid_;
  std::unique_ptr<std::uint8_t[], FreeMarks> marks_;
  std::vector<Entry> entries_;
  struct KnownPage {
    openvdb::Coord origin;
    SurfaceGrid::Page* page = nullptr;
  };
  std::array<KnownPage, 8> pages_;  // by the parity of their coordinates
};

}  // namespace vox
