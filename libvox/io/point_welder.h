#pragma once

#include "libvox/core/types.h"

#include <bit>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <vector>

namespace vox {

/// Finds the point with a position; adds it if there is none. An open-addressing hash table of
/// point indices, at most half full. -0 equals +0. Numbers are floats or doubles.
template <class Number>
class PointWelder {
 public:
  using Point = Eigen::Matrix<Number, 3, 1>;

  /// `expected` points fit before the table grows.
  PointWelder(std::vector<Point>& points, std::size_t expected)
      : points_(points), slots_(std::bit_ceil(2 * (expected + 1)), kNone) {}

  Index indexOf(const Point& position) {
    const Index found = slots_[slotOf(position)];
    return found != kNone ? found : add(position);
  }

  static std::uint64_t hash(const Point& position) {
    using Bits = std::conditional_t<sizeof(Number) == 4, std::uint32_t, std::uint64_t>;
    const auto bits = [&](int axis) -> std::uint64_t {
      return std::bit_cast<Bits>(position[axis] + Number{0});  // + 0 turns -0 into +0
    };
    std::uint64_t h = (bits(0) ^ std::rotl(bits(1), 32)) * 0x9e3779b97f4a7c15U;
    h = (h ^ (h >> 29) ^ bits(2)) * 0xbf58476d1ce4e5b9U;
    return h ^ (h >> 32);
  }

 private:
  // The slot of this position, or the free slot where it is to be put.
  std::size_t slotOf(const Point& position) const {
    const std::size_t mask = slots_.size() - 1;
    std::size_t slot = hash(position) & mask;
    while (slots_[slot] != kNone && points_[slots_[slot]] != position) slot = (slot + 1) & mask;
    return slot;
  }

  [[gnu::noinline]] Index add(const Point& position) {
    if (2 * (points_.size() + 1) > slots_.size()) grow();
    const auto index = static_cast<Index>(points_.size());
    slots_[slotOf(position)] = index;
    points_.push_back(position);
    return index;
  }

  void grow() {
    slots_.assign(2 * slots_.size(), kNone);
    for (std::size_t v = 0; v < points_.size(); ++v)
      slots_[slotOf(points_[v])] = static_cast<Index>(v);
  }

  std::vector<Point>& points_;
  std::vector<Index> slots_;
};

}  // namespace vox
