// Vertices of a tile by forward differences, many rows at a time.

// Highway compiles this file once per instruction set, between HWY_BEFORE_ and HWY_AFTER_NAMESPACE.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "libvox/voxelize/tile.cpp"
#include "libvox/voxelize/tile.h"

#include "libvox/grid/mark_brick.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <bit>
#include <cmath>

#ifndef VOX_TILE_SHARED
#define VOX_TILE_SHARED
namespace vox {
namespace {

constexpr int kFractionBits = 27;  // and 5 for the 32 voxels of a MarkBrick
constexpr std::uint32_t kHalf = std::uint32_t{1} << (kFractionBits - 1);
/// Added to a double below 2^51, it rounds the double and leaves the integer in its low bits.
constexpr double kToInteger = 6755399441055744.0;  // 1.5 * 2^52

constexpr std::size_t kMostRows = std::size_t{1} << kMostTileLevels;

/// Weights of the patch for every row of a tile; 0 beyond the last row.
struct RowWeights {
  alignas(64) std::array<double, kMostRows> minus{};
  alignas(64) std::array<double, kMostRows> plus{};
};

std::array<RowWeights, kMostTileLevels + 1> makeRowWeights() {
  std::array<RowWeights, kMostTileLevels + 1> all;
  for (int k = 0; k <= kMostTileLevels; ++k)
    for (std::size_t i = 0; i < std::size_t{1} << k; ++i) {
      const PatchWeights weights(static_cast<std::int64_t>(i), std::int64_t{1} << k);
      all[static_cast<std::size_t>(k)].minus[i] = weights.minus;
      all[static_cast<std::size_t>(k)].plus[i] = weights.plus;
    }
  return all;
}
const std::array<RowWeights, kMostTileLevels + 1> kRowWeights = makeRowWeights();

/// Start values of the rows: the coordinates of the first vertex, and their first and second
/// differences along the row. Each is a quadratic across the rows, given by three control values,
/// in units of 2^-kFractionBits voxels.
using Quadratic = std::array<double, 3>;  // at minus, zero, plus
struct RowStarts {
  std::array<Quadratic, 3> value, first, second;
};

RowStarts rowStarts(const TileControls& controls, int k) {
  const double scale = std::ldexp(1.0, kFractionBits);
  const double n = std::ldexp(1.0, k);
  const double startMinus = (n - 1) / (2 * n);  // weight of the point before, at the start of a row
  RowStarts starts;
  for (std::size_t axis = 0; axis < 3; ++axis)
    for (std::size_t u = 0; u < 3; ++u) {
      const auto& p = controls[axis][u];
      const double minus = (p[0] - p[1]) * scale;
      const double plus = (p[2] - p[1]) * scale;
      starts.value[axis][u] = p[1] * scale + startMinus * minus;
      starts.first[axis][u] = (plus - (n - 1) * minus) / (n * n);
      starts.second[axis][u] = (plus + minus) / (n * n);
    }
  return starts;
}

/// Start values of each row, as integers.
struct Rows {
  using Column = std::array<std::uint32_t, kMostRows>;
  alignas(64) std::array<Column, 3> value;
  alignas(64) std::array<Column, 3> first;
  alignas(64) std::array<Column, 3> second;
};

}  // namespace
}  // namespace vox
#endif

HWY_BEFORE_NAMESPACE();
namespace vox::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET == HWY_SCALAR

inline void fillRows(const Quadratic& q, const RowWeights& weights, std::size_t rows,
                     std::uint32_t offset, std::uint32_t* out) {
  for (std::size_t i = 0; i < rows; ++i) {
    const double value =
        q[1] + (weights.minus[i] * (q[0] - q[1]) + weights.plus[i] * (q[2] - q[1]));
    out[i] = static_cast<std::uint32_t>(std::bit_cast<std::uint64_t>(value + kToInteger)) + offset;
  }
}

template <class Visit>
void stepRows(const Rows& rows, std::size_t n, Visit&& visit) {
  for (std::size_t i = 0; i < n; ++i) {
    std::array<std::uint32_t, 3> value, first;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      value[axis] = rows.value[axis][i];
      first[axis] = rows.first[axis][i];
    }
    for (std::size_t j = 0; j < n; ++j) {
      visit(value);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        value[axis] += first[axis];
        first[axis] += rows.second[axis][i];
      }
    }
  }
}

inline void markRows(const Rows& rows, std::size_t n, std::uint8_t* marks) {
  stepRows(rows, n, [&](const std::array<std::uint32_t, 3>& at) {
    const std::uint32_t x = at[0] >> kFractionBits;
    const std::uint32_t y = at[1] >> kFractionBits;
    const std::uint32_t z = at[2] >> kFractionBits;
    marks[(x & 24U) << 10U | (y & 24U) << 8U | (z & 24U) << 6U | (x & 7U) << 6U | (y & 7U) << 3U |
          (z & 7U)] = MarkBrick::kMarked;
  });
}

inline std::uint32_t sumRows(const Rows& rows, std::size_t n) {
  std::uint32_t sum = 0;
  stepRows(rows, n, [&](const std::array<std::uint32_t, 3>& at) { sum += at[0] + at[1] + at[2]; });
  return sum;
}

#else

inline void fillRows(const Quadratic& q, const RowWeights& weights, std::size_t rows,
                     std::uint32_t offset, std::uint32_t* HWY_RESTRICT out) {
  const hn::CappedTag<double, 8> d;
  const hn::Repartition<std::uint32_t, decltype(d)> d32;
  const std::size_t lanes = hn::Lanes(d);
  const auto zero = hn::Set(d, q[1]);
  const auto minus = hn::Set(d, q[0] - q[1]);
  const auto plus = hn::Set(d, q[2] - q[1]);
  const auto toInteger = hn::Set(d, kToInteger);
  const auto shift = hn::Set(d32, offset);
  const auto at = [&](std::size_t i) {
    const auto sum = hn::Add(hn::Mul(hn::Load(d, weights.minus.data() + i), minus),
                             hn::Mul(hn::Load(d, weights.plus.data() + i), plus));
    return hn::BitCast(d32, hn::Add(hn::Add(zero, sum), toInteger));
  };
  for (std::size_t i = 0; i < rows; i += 2 * lanes)
    hn::Store(hn::Add(hn::ConcatEven(d32, at(i + lanes), at(i)), shift), d32, out + i);
}

/// The coordinates of one vertex in each of several rows, with their differences.
template <class D>
struct Stepper {
  using V = hn::Vec<D>;
  V x, y, z, dx, dy, dz, ddx, ddy, ddz;

  HWY_INLINE Stepper(D d, const Rows& rows, std::size_t i)
      : x(hn::Load(d, rows.value[0].data() + i)),
        y(hn::Load(d, rows.value[1].data() + i)),
        z(hn::Load(d, rows.value[2].data() + i)),
        dx(hn::Load(d, rows.first[0].data() + i)),
        dy(hn::Load(d, rows.first[1].data() + i)),
        dz(hn::Load(d, rows.first[2].data() + i)),
        ddx(hn::Load(d, rows.second[0].data() + i)),
        ddy(hn::Load(d, rows.second[1].data() + i)),
        ddz(hn::Load(d, rows.second[2].data() + i)) {}

  HWY_INLINE void step() {
    x = hn::Add(x, dx);
    y = hn::Add(y, dy);
    z = hn::Add(z, dz);
    dx = hn::Add(dx, ddx);
    dy = hn::Add(dy, ddy);
    dz = hn::Add(dz, ddz);
  }
};

/// The high halves of a in the even lanes and of b in the odd lanes. Their five high bits are the
/// voxel.
template <class D16, class V>
HWY_INLINE hn::Vec<D16> highHalves(D16 d16, V a, V b) {
  return hn::OddEven(hn::BitCast(d16, b), hn::BitCast(d16, hn::ShiftRight<16>(a)));
}

/// Index of a mark (mark_brick.h) from coordinates whose bits 11-15 are the voxel.
template <class D16, class V>
HWY_INLINE V markIndex(D16 d16, V x, V y, V z) {
  const auto in = hn::Set(d16, std::uint16_t{0x3800});
  const auto of = hn::Set(d16, std::uint16_t{0xC000});
  const auto xInZOf = hn::ShiftRight<5>(hn::Or(hn::And(x, in), hn::And(z, of)));
  const auto yIn = hn::ShiftRight<8>(hn::And(y, in));
  const auto zIn = hn::ShiftRight<11>(hn::And(z, in));
  const auto yOf = hn::ShiftRight<3>(hn::And(y, of));
  const auto xOf = hn::ShiftRight<1>(hn::And(x, of));
  return hn::Or(hn::Or(xInZOf, yIn), hn::Or(zIn, hn::Or(yOf, xOf)));
}

template <std::size_t kCap>
void markGroups(const Rows& rows, std::size_t n, std::uint8_t* HWY_RESTRICT marks) {
  const hn::CappedTag<std::uint32_t, kCap> d;
  const hn::Repartition<std::uint16_t, decltype(d)> d16;
  constexpr std::size_t kMostLanes = 2 * kCap;
  alignas(64) std::array<std::uint16_t, kMostLanes> index;
  const std::size_t lanes = hn::Lanes(d);
  for (std::size_t i = 0; i < n; i += 2 * lanes) {
    Stepper<decltype(d)> a(d, rows, i);
    Stepper<decltype(d)> b(d, rows, i + lanes);
    for (std::size_t j = 0; j < n; ++j) {
      hn::Store(markIndex(d16, highHalves(d16, a.x, b.x), highHalves(d16, a.y, b.y),
                          highHalves(d16, a.z, b.z)),
                d16, index.data());
      a.step();
      b.step();
      for (std::size_t lane = 0; lane < 2 * lanes; ++lane) marks[index[lane]] = MarkBrick::kMarked;
    }
  }
}

inline void markRows(const Rows& rows, std::size_t n, std::uint8_t* marks) {
  if (n >= 32)
    markGroups<16>(rows, n, marks);
  else if (n == 16)
    markGroups<8>(rows, n, marks);
  else
    markGroups<4>(rows, n, marks);
}

inline std::uint32_t sumRows(const Rows& rows, std::size_t n) {
  const hn::CappedTag<std::uint32_t, 8> d;
  const std::size_t lanes = hn::Lanes(d);
  auto sum = hn::Zero(d);
  for (std::size_t i = 0; i < n; i += lanes) {
    Stepper<decltype(d)> at(d, rows, i);
    for (std::size_t j = 0; j < n; ++j) {
      sum = hn::Add(sum, hn::Add(at.x, hn::Add(at.y, at.z)));
      at.step();
    }
  }
  return hn::GetLane(hn::SumOfLanes(d, sum));
}

#endif

inline void makeRows(const TileControls& controls, int k, Rows& rows) {
  const RowStarts starts = rowStarts(controls, k);
  const RowWeights& weights = kRowWeights[static_cast<std::size_t>(k)];
  const std::size_t n = std::size_t{1} << k;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    fillRows(starts.value[axis], weights, n, kHalf, rows.value[axis].data());
    fillRows(starts.first[axis], weights, n, 0, rows.first[axis].data());
    fillRows(starts.second[axis], weights, n, 0, rows.second[axis].data());
  }
}

void mark(const TileControls& controls, int k, std::uint8_t* marks) {
  Rows rows;
  makeRows(controls, k, rows);
  markRows(rows, std::size_t{1} << k, marks);
}

std::uint32_t sum(const TileControls& controls, int k) {
  Rows rows;
  makeRows(controls, k, rows);
  return sumRows(rows, std::size_t{1} << k);
}

}  // namespace vox::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vox {
namespace {

HWY_EXPORT(mark);
HWY_EXPORT(sum);

}  // namespace

TileControls tileControls(const Patch& patch) {
  TileControls controls;
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    constexpr double kSide = MarkBrick::kVoxelSide;
    const double origin = kSide * std::floor(patch.points[1][1][axis] / kSide);
    for (std::size_t u = 0; u < 3; ++u)
      for (std::size_t v = 0; v < 3; ++v) controls[a][u][v] = patch.points[u][v][axis] - origin;
  }
  return controls;
}

void markTile(const TileControls& controls, int k, std::uint8_t* marks) {
  HWY_DYNAMIC_DISPATCH(mark)(controls, k, marks);
}

std::uint32_t sumTile(const TileControls& controls, int k) {
  return HWY_DYNAMIC_DISPATCH(sum)(controls, k);
}

}  // namespace vox
#endif
