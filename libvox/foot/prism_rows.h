#pragma once

#include "libvox/foot/cell.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vox {

/// The voxels of a bin that lie in a prism, as rows along z. Coordinates are relative to the lowest
/// voxel of the bin.
class PrismRows {
 public:
  static constexpr int kGroup = 8;  ///< rows at a time
  using Group = std::array<float, kGroup>;

  PrismRows(const Prism& prism, const openvdb::Coord& binOrigin) {
    for (int axis = 0; axis < 3; ++axis) {
      const auto k = static_cast<std::size_t>(axis);
      low[k] = std::max(0, prism.box.min()[axis] - binOrigin[axis]);
      high[k] = std::min(kBinSide - 1, prism.box.max()[axis] - binOrigin[axis]);
      centre[k] = static_cast<float>(prism.origin[axis] - binOrigin[axis]) + prism.centre[k];
    }
    for (std::size_t k = 0; k < 3; ++k) {
      // A plane along z is tilted a little, so that every plane cuts rows at one place.
      constexpr float kLeast = 1e-4F;
      const Float3& n = prism.normals[k];
      const float inverse = 1 / (std::abs(n[2]) < kLeast ? std::copysign(kLeast, n[2]) : n[2]);
      perX_[k] = -n[0] * inverse;
      perY_[k] = -n[1] * inverse;
      middle_[k] = centre[2] - perX_[k] * centre[0] - perY_[k] * centre[1];
      reach_[k] = std::abs(inverse);
    }
  }

  bool empty() const { return low[0] > high[0] || low[1] > high[1] || low[2] > high[2]; }

  /// First and last z of the rows x, firstY, firstY + 1, ...: integers; first > last if the row has
  /// no voxel. Rows outside low and high are empty.
  void rowsAt(int x, int firstY, Group& first, Group& last) const {
    const auto fx = static_cast<float>(x);
    Group from, to;
    from.fill(static_cast<float>(low[2]));
    to.fill(static_cast<float>(high[2]));
    for (std::size_t k = 0; k < 3; ++k) {
      const float atRow = middle_[k] + perX_[k] * fx;
      for (std::size_t r = 0; r < kGroup; ++r) {
        const float at = atRow + perY_[k] * static_cast<float>(firstY + static_cast<int>(r));
        from[r] = std::max(from[r], at - reach_[k]);
        to[r] = std::min(to[r], at + reach_[k]);
      }
    }
    // Whole numbers by conversion: from and, in rows with voxels, to are not negative.
    for (std::size_t r = 0; r < kGroup; ++r) {
      const int y = firstY + static_cast<int>(r);
      const bool inside = (y >= low[1]) & (y <= high[1]) & (from[r] <= to[r]);
      const float down = static_cast<float>(static_cast<int>(inside ? from[r] : 0.0F));
      const float up = down < from[r] ? down + 1 : down;
      first[r] = inside ? up : 1.0F;
      last[r] = static_cast<float>(static_cast<int>(inside ? to[r] : 0.0F));
    }
  }

  std::array<int, 3> low, high;  ///< box of voxels
  Float3 centre;                 ///< of the prism

 private:
  std::array<float, 3> middle_, perX_, perY_, reach_;
};

}  // namespace vox
