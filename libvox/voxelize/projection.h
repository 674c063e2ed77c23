#pragma once

#include "libvox/voxelize/lattice.h"

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <utility>

namespace vox::detail {

/// The projection of a triangle along one axis, with coordinates a and b. Edge i does not separate
/// the box of widths padA, padB around centre (a, b) from the triangle iff
/// 2 A a + 2 B b + padA |A| + padB |B| >= level. If the projection is a segment, its edges point
/// both ways and bound it on both sides.
template <class Int>
class Projection {
 public:
  Projection(const std::array<Lattice, 3>& corners, int axisA, int axisB) {
    const auto a = [&](int i) { return Int{corners[i % 3][axisA]}; };
    const auto b = [&](int i) { return Int{corners[i % 3][axisB]}; };
    const Int twiceArea = (a(1) - a(0)) * (b(2) - b(0)) - (b(1) - b(0)) * (a(2) - a(0));
    const Int sign = twiceArea < 0 ? -1 : 1;
    for (int i = 0; i < 3; ++i) {
      const Int normalA = sign * (b(i) - b(i + 1));
      const Int normalB = sign * (a(i + 1) - a(i));
      const Int offset = normalA * a(i) + normalB * b(i);
      edges_[i] = {normalA, normalB, -(-offset >> kHalfLog2)};
    }
    const auto [lowA, highA] =
        std::minmax({corners[0][axisA], corners[1][axisA], corners[2][axisA]});
    const auto [lowB, highB] =
        std::minmax({corners[0][axisB], corners[1][axisB], corners[2][axisB]});
    rangeA_ = {lowA, highA};
    rangeB_ = {lowB, highB};
  }

  /// Sets `rows`, for b = firstB, firstB + 1, ..., to the voxels a whose boxes are not separated
  /// from the triangle in this projection.
  void slice(int padA, int padB, std::int32_t firstB, std::span<Interval> rows) const;

 private:
  struct Edge {
    Int normalA, normalB, level;
  };
  std::array<Edge, 3> edges_;
  std::pair<std::int64_t, std::int64_t> rangeA_, rangeB_;
};

template <class Int>
void Projection<Int>::slice(int padA, int padB, std::int32_t firstB,
                            std::span<Interval> rows) const {
  const Interval acrossA = voxelsAcross(rangeA_.first, rangeA_.second, padA);
  Interval acrossB = voxelsAcross(rangeB_.first, rangeB_.second, padB);
  for (const Edge& edge : edges_) {  // an edge parallel to a bounds the rows
    if (edge.normalA != 0 || edge.normalB == 0) continue;
    const Int reach = edge.level - padB * magnitude(edge.normalB);
    const Int bound = floorDiv<Int>(-reach, 2 * magnitude(edge.normalB));
    if (edge.normalB > 0)
      acrossB.lo = static_cast<std::int32_t>(std::max<Int>(acrossB.lo, -bound));
    else
      acrossB.hi = static_cast<std::int32_t>(std::min<Int>(acrossB.hi, bound));
  }

  const std::int32_t end = firstB + static_cast<std::int32_t>(rows.size());
  const std::int32_t from = std::clamp(acrossB.lo, firstB, end);
  const std::int32_t to = std::clamp(acrossB.hi < end ? acrossB.hi + 1 : end, from, end);
  std::fill(rows.begin(), rows.begin() + (from - firstB), kNothing);
  std::fill(rows.begin() + (to - firstB), rows.end(), kNothing);
  const auto met =
      rows.subspan(static_cast<std::size_t>(from - firstB), static_cast<std::size_t>(to - from));
  std::fill(met.begin(), met.end(), acrossA);
  if (met.empty()) return;
  for (const Edge& edge : edges_) {
    if (edge.normalA == 0) continue;
    // 2 |A| (+-a) >= reach - 2 B b
    const Int width = 2 * magnitude(edge.normalA);
    const Int reach = edge.level - padA * magnitude(edge.normalA) - padB * magnitude(edge.normalB);
    FloorLine<Int> line(2 * edge.normalB * from - reach, 2 * edge.normalB, width);
    if (edge.normalA > 0)
      for (Interval& row : met) {
        row.lo = static_cast<std::int32_t>(std::max<Int>(row.lo, -line.floor));
        line.next();
      }
    else
      for (Interval& row : met) {
        row.hi = static_cast<std::int32_t>(std::min<Int>(row.hi, line.floor));
        line.next();
      }
  }
}

}  // namespace vox::detail
