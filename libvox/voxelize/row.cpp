// Vertices of a row, several at a time.

// Highway compiles this file once per instruction set, between HWY_BEFORE_ and HWY_AFTER_NAMESPACE.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "libvox/voxelize/row.cpp"
#include "libvox/voxelize/row.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace vox::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

void evaluate(const CurvePoints& points, double n, double first, std::size_t count,
              LeafCache::Positions& positions) {
  constexpr std::size_t kMostLanes = 8;
  const hn::CappedTag<double, kMostLanes> d;
  const Vec3d minus = points[0] - points[1];
  const Vec3d plus = points[2] - points[1];
  const auto size = hn::Set(d, n);
  const auto one = hn::Set(d, 1.0);
  const auto scale = hn::Set(d, 1 / (2 * n * n));  // exact
  for (std::size_t lane = 0; lane < count; lane += hn::Lanes(d)) {
    const auto j = hn::Iota(d, first + static_cast<double>(lane));
    const auto left = hn::Sub(size, j);
    const auto weightMinus = hn::Mul(hn::Mul(left, hn::Sub(left, one)), scale);
    const auto weightPlus = hn::Mul(hn::Mul(j, hn::Add(j, one)), scale);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<Eigen::Index>(axis);
      const auto fromMinus = hn::Mul(weightMinus, hn::Set(d, minus[a]));
      const auto fromPlus = hn::Mul(weightPlus, hn::Set(d, plus[a]));
      hn::Store(hn::Add(hn::Set(d, points[1][a]), hn::Add(fromMinus, fromPlus)), d,
                positions.axis[axis].data() + lane);
    }
  }
}

}  // namespace vox::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vox {
namespace {

HWY_EXPORT(evaluate);

}  // namespace

void setRow(const CurvePoints& points, std::int64_t n, std::int64_t first, std::size_t count,
            LeafCache::Positions& positions) {
  HWY_DYNAMIC_DISPATCH(evaluate)
  (points, static_cast<double>(n), static_cast<double>(first), count, positions);
}

}  // namespace vox
#endif
