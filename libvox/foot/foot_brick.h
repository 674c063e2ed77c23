#pragma once

#include "libvox/foot/cell.h"

#include <array>
#include <bit>
#include <cstdint>

namespace vox {

/// A distance with a sign as a key: the smaller of two keys has the smaller |t|, and of equal ones
/// the one with plus. So the nearest of many surfaces does not depend on their order.
inline std::uint32_t keyOf(float t) {
  return std::rotl(std::bit_cast<std::uint32_t>(t), 1);
}
inline float distanceOf(std::uint32_t key) {
  return std::bit_cast<float>(std::rotr(key, 1));
}
inline constexpr std::uint32_t kNoKey = 0xFFFFFFFF;  ///< larger than all other keys

/// Keys of the voxels of a bin: 4 x 4 x 4 leaves of 8 x 8 x 8 voxels, both in OpenVDB's order (x
/// slowest). Only leaves that are touched are set.
class FootBrick {
 public:
  static constexpr int kLeaves = 64;
  static constexpr int kVoxels = 512;  ///< of a leaf

  void clear() { touched_ = 0; }
  /// A set of leaves: bit i stands for leaf i.
  std::uint64_t touched() const { return touched_; }
  /// The keys of a leaf; at first kNoKey.
  std::uint32_t* leaf(unsigned number) {
    if ((touched_ >> number & 1U) == 0) {
      touched_ |= std::uint64_t{1} << number;
      keys_[number].fill(kNoKey);
    }
    return keys_[number].data();
  }

  static openvdb::Coord leafOrigin(const openvdb::Coord& bin, unsigned number) {
    const auto at = [](unsigned place) { return static_cast<int>(place & 3U) * 8; };
    return bin.offsetBy(at(number >> 4), at(number >> 2), at(number));
  }

 private:
  alignas(64) std::array<std::array<std::uint32_t, kVoxels>, kLeaves> keys_;
  std::uint64_t touched_ = 0;
};

}  // namespace vox
