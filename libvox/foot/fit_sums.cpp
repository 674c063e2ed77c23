// Sums of powers, eight points at a time.

// Highway compiles this file once per instruction set, between HWY_BEFORE_ and HWY_AFTER_NAMESPACE.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "libvox/foot/fit_sums.cpp"
#include "libvox/foot/fit_sums.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace vox::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Loops run over the points of a group, so that the compiler uses vectors.
void addUp(const PointsToFit& points, std::size_t count, FitSums& sums) {
  constexpr std::size_t kGroup = PointsToFit::kGroup;
  using Group = std::array<double, kGroup>;
  alignas(64) std::array<Group, 45> powers = {};
  alignas(64) std::array<Group, 15> heights = {};
  for (std::size_t begin = 0; begin < count; begin += kGroup) {
    alignas(64) Group a, height, ofB;
    for (std::size_t k = 0; k < kGroup; ++k) {
      a[k] = points.a[begin + k];
      height[k] = points.height[begin + k];
      ofB[k] = points.weight[begin + k];
    }
    std::size_t m = 0, n = 0;
    for (std::size_t j = 0; j < 9; ++j) {
      alignas(64) Group power = ofB;
      for (std::size_t i = 0; i + j < 9; ++i, ++m) {
        for (std::size_t k = 0; k < kGroup; ++k) powers[m][k] += power[k];
        if (i + j < 5) {
          for (std::size_t k = 0; k < kGroup; ++k) heights[n][k] += power[k] * height[k];
          ++n;
        }
        for (std::size_t k = 0; k < kGroup; ++k) power[k] *= a[k];
      }
      for (std::size_t k = 0; k < kGroup; ++k) ofB[k] *= points.b[begin + k];
    }
  }
  const auto sumOf = [](const Group& g) {
    return ((g[0] + g[1]) + (g[2] + g[3])) + ((g[4] + g[5]) + (g[6] + g[7]));
  };
  for (std::size_t j = 0, m = 0; j < 9; ++j)
    for (std::size_t i = 0; i + j < 9; ++i) sums.powers[j][i] = sumOf(powers[m++]);
  for (std::size_t n = 0; n < heights.size(); ++n) sums.heights[n] = sumOf(heights[n]);
}

}  // namespace vox::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vox {
namespace {

HWY_EXPORT(addUp);

}  // namespace

FitSums sumsOf(const PointsToFit& points, std::size_t count) {
  FitSums sums;
  HWY_DYNAMIC_DISPATCH(addUp)(points, count, sums);
  return sums;
}

}  // namespace vox
#endif
