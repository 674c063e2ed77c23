#pragma once

#include "libvox/grid/surface_grid.h"

#include <array>
#include <cstdint>
#include <memory>

namespace vox {

/// A task's private window on a SurfaceGrid: 4 x 4 x 4 leaves, one byte per voxel, small enough for
/// the first-level cache. Slots are leaf coordinates modulo 4, so the window lies wherever its
/// leaves are: a claim puts a leaf in its slot and sends the one that was there to the grid.
///
/// mark index of a voxel: bits 0-2 z, 3-5 y, 6-8 x (within the leaf, OpenVDB's order), 9-10 z,
/// 11-12 y, 13-14 x (of the leaf).
///
/// One per thread. What it holds reaches the grid with flush() at the latest.
class LeafCache {
 public:
  static constexpr int kLeafLog2 = 3;
  static constexpr int kSideLog2 = 2;  ///< leaves along a side
  static constexpr int kSide = 1 << kSideLog2;
  static constexpr int kVoxelSide = kSide << kLeafLog2;  ///< 32
  static constexpr std::size_t kMarks = std::size_t{1} << (3 * (kLeafLog2 + kSideLog2));
  static constexpr std::uint8_t kMarked = 0xFF;

  explicit LeafCache(SurfaceGrid& grid);

  /// Makes room for the leaves of a box of voxels, at most kSide along each axis.
  /// @throws LimitError  the grid may not grow
  void claim(const openvdb::Coord& low, const openvdb::Coord& high);

  /// Marks one voxel, claiming its leaf.
  void mark(const openvdb::Coord& voxel);

  /// kMarks bytes; kMarked where a voxel of a claimed leaf is black.
  std::uint8_t* marks() { return marks_.get(); }

  /// Sends everything to the grid.
  void flush();

 private:
  struct FreeMarks {
    void operator()(std::uint8_t* marks) const;
  };
  using LeafCoord = std::array<std::int32_t, 4>;  // the last is 0
  void claimLeaf(std::int32_t x, std::int32_t y, std::int32_t z);
  void send(std::size_t slot);

  SurfaceGrid& grid_;
  std::unique_ptr<std::uint8_t[], FreeMarks> marks_;
  std::array<LeafCoord, std::size_t{1} << (3 * kSideLog2)> leaves_;
  openvdb::Coord pageOrigin_;
  SurfaceGrid::Page* page_ = nullptr;
};

}  // namespace vox
