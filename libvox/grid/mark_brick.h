#pragma once

#include "libvox/grid/merge_leaf.h"
#include "libvox/grid/openvdb.h"

#include <array>
#include <cstdint>
#include <memory>

namespace vox {

/// A brick of 4 x 4 x 4 leaves in which kernels mark voxels as bytes; small enough for the
/// first-level cache. Leaves are addressed by their coordinates modulo 4, so the brick can stand
/// for any 4 x 4 x 4 neighbouring leaves. Not thread-safe.
///
/// Mark index of a voxel: bits 0-2 z, 3-5 y, 6-8 x (within the leaf, OpenVDB's order), 9-10 z,
/// 11-12 y, 13-14 x (of the leaf).
class MarkBrick {
 public:
  static constexpr int kLeafLog2 = 3;
  static constexpr int kSideLog2 = 2;                    ///< leaves along a side
  static constexpr int kSide = 1 << kSideLog2;           ///< 4
  static constexpr int kVoxelSide = kSide << kLeafLog2;  ///< 32
  static constexpr std::size_t kLeaves = std::size_t{1} << (3 * kSideLog2);
  static constexpr std::size_t kLeafMarks = std::size_t{1} << (3 * kLeafLog2);
  static constexpr std::size_t kMarks = kLeaves * kLeafMarks;
  static constexpr std::uint8_t kMarked = 0xFF;  ///< byte of a marked voxel, else 0

  MarkBrick();

  /// The marks: kMarks bytes, all 0 after take().
  std::uint8_t* marks() { return marks_.get(); }

  /// The leaves that had marks, and the marks as bits.
  struct Taken {
    std::size_t count = 0;
    std::array<openvdb::Coord, kLeaves> origins;
    /// One more than there are leaves: the vector unit may write some bytes behind the last one.
    alignas(64) std::array<LeafWords, kLeaves + 1> words;
  };

  /// Moves the marks of the leaves of a box of voxels to `taken`; clears them in the brick.
  /// Precondition: the box fits; no other leaf has marks.
  void take(const openvdb::Coord& low, const openvdb::Coord& high, Taken& taken);

  /// Index of the first mark of a leaf.
  static std::size_t firstMark(const openvdb::Coord& leafOrigin) {
    constexpr std::int32_t kMask = kSide - 1;
    const auto in = [](std::int32_t v) { return static_cast<std::size_t>(v >> kLeafLog2 & kMask); };
    return (in(leafOrigin.x()) << (2 * kSideLog2) | in(leafOrigin.y()) << kSideLog2 |
            in(leafOrigin.z())) *
           kLeafMarks;
  }

  /// Whether a box of voxels touches at most kSide leaves along each axis.
  static bool fits(const openvdb::Coord& low, const openvdb::Coord& high) {
    const openvdb::Coord leaves = (high >> kLeafLog2) - (low >> kLeafLog2);
    return leaves.x() < kSide && leaves.y() < kSide && leaves.z() < kSide;
  }

 private:
  struct FreeMarks {
    void operator()(std::uint8_t* marks) const;
  };
  std::unique_ptr<std::uint8_t[], FreeMarks> marks_;
};

}  // namespace vox
