#pragma once

#include "libvox/foot/cell.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vox {

/// The voxels of a bin that lie in a prism, as rows along z. Coordinates are relative to the lowest
/// voxel of the bin.
struct PrismRows {
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
      perX[k] = -n[0] * inverse;
      perY[k] = -n[1] * inverse;
      middle[k] = centre[2] - perX[k] * centre[0] - perY[k] * centre[1];
      reach[k] = std::abs(inverse);
    }
  }

  bool empty() const { return low[0] > high[0] || low[1] > high[1] || low[2] > high[2]; }

  std::array<int, 3> low, high;  ///< box of voxels
  Float3 centre;                 ///< of the prism
  /// Row x, y lies between the planes k where z is at most reach[k] from middle[k] + perX[k] x +
  /// perY[k] y.
  std::array<float, 3> middle, perX, perY, reach;
};

}  // namespace vox
