#pragma once

#include "libvox/voxelize/scan.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>

namespace vox::detail {

// Integer arithmetic of the scan: points on its lattice, intervals of voxels, stepped quotients.

__extension__ using Int128 = __int128;

inline constexpr std::int64_t kUnit = 65536;  // lattice steps per voxel
inline constexpr std::int64_t kHalf = kUnit / 2;
inline constexpr int kHalfLog2 = 15;
static_assert(kScanLattice * kUnit == 1);

using Lattice = std::array<std::int64_t, 3>;

template <class Int>
Int floorDiv(Int a, Int positive) {
  const Int quotient = a / positive;
  return quotient - (a % positive < 0);
}

template <class Int>
Int magnitude(Int x) {
  return x < 0 ? -x : x;
}

/// Voxels [lo, hi] in a row; empty if lo > hi.
struct Interval {
  std::int32_t lo, hi;  // not initialized: most triangles use a small part of their tables

  bool contains(std::int32_t x) const { return (lo <= x) & (x <= hi); }
  bool empty() const { return lo > hi; }
  std::size_t size() const { return static_cast<std::size_t>(hi - lo + 1); }
  Interval common(Interval other) const { return {std::max(lo, other.lo), std::min(hi, other.hi)}; }
  Interval hull(Interval other) const {
    if (empty() || other.empty()) return empty() ? other : *this;
    return {std::min(lo, other.lo), std::max(hi, other.hi)};
  }
};
inline constexpr Interval kNothing = {1, 0};

/// Voxels whose centre is within half width pad / 2 of [min, max].
/// @param min, max  in lattice steps
/// @param pad       in voxels
inline Interval voxelsAcross(std::int64_t min, std::int64_t max, int pad) {
  return {static_cast<std::int32_t>(-floorDiv(pad * kHalf - min, kUnit)),
          static_cast<std::int32_t>(floorDiv(max + pad * kHalf, kUnit))};
}

/// floor((start + i step) / divisor) for i = 0, 1, 2, ...: `floor` is the current value, `rest` the
/// remainder.
template <class Int>
struct FloorLine {
  FloorLine(Int start, Int step, Int positive)
      : floor(floorDiv(start, positive)),
        rest(start - floor * positive),
        stepFloor(floorDiv(step, positive)),
        stepRest(step - stepFloor * positive),
        divisor(positive) {}

  void next() {
    rest += stepRest;
    const Int carry = -Int{rest >= divisor};  // all bits or none; a branch would be mispredicted
    rest -= divisor & carry;
    floor += stepFloor - carry;
  }

  Int floor, rest, stepFloor, stepRest, divisor;
};

}  // namespace vox::detail
