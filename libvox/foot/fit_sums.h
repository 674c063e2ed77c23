#pragma once

#include <array>
#include <cstddef>

namespace vox {

/// Heights at some places, in columns. Those that are not set count nothing.
struct PointsToFit {
  static constexpr std::size_t kGroup = 8;
  static constexpr std::size_t kMost = 40;
  using Column = std::array<double, kMost>;
  alignas(64) Column a = {};
  alignas(64) Column b = {};
  alignas(64) Column height = {};
  alignas(64) Column weight = {};  ///< 0 or 1

  void set(std::size_t i, double atA, double atB, double heightThere) {
    a[i] = atA, b[i] = atB, height[i] = heightThere, weight[i] = 1;
  }
};

/// The sums of a least squares fit of a polynomial of degree 4.
struct FitSums {
  std::array<std::array<double, 9>, 9> powers;  ///< of a^i b^j: [j][i], i + j <= 8
  std::array<double, 15> heights;  ///< of a^i b^j times the height, i + j <= 4; by j, then by i
};

/// Adds up points 0 .. count - 1. The same bits on every processor.
FitSums sumsOf(const PointsToFit& points, std::size_t count);

}  // namespace vox
