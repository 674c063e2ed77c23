// Normals of a tile, several columns at a time.

// Highway compiles this file once per instruction set, between HWY_BEFORE_ and HWY_AFTER_NAMESPACE.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "libvox/voxelize/normal_tile.cpp"
#include "libvox/voxelize/normal_tile.h"

#include "libvox/grid/mark_brick.h"
#include "libvox/voxelize/tile.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <array>

#ifndef VOX_NORMAL_TILE_SHARED
#define VOX_NORMAL_TILE_SHARED
namespace vox {
namespace {

constexpr std::size_t kMostColumns = std::size_t{1} << kMostNormalLevels;
static_assert(1 << (2 * kMostNormalLevels) <= VoxelMeans::kMostBrickSamples);

/// Weights along v of the previous and the next control point: for vertices (minus, plus) and for
/// limit points (limitMinus, limitPlus, at parameter t).
struct ColumnWeights {
  using Column = std::array<float, kMostColumns>;
  alignas(64) Column minus{};
  alignas(64) Column plus{};
  alignas(64) Column limitMinus{};
  alignas(64) Column limitPlus{};
  alignas(64) Column t{};
};

std::array<ColumnWeights, kMostNormalLevels + 1> makeColumnWeights() {
  std::array<ColumnWeights, kMostNormalLevels + 1> all;
  for (std::size_t k = 0; k < all.size(); ++k) {
    const std::int64_t n = std::int64_t{1} << k;
    for (std::int64_t j = 0; j < n; ++j) {
      const auto at = static_cast<std::size_t>(j);
      const PatchWeights weights(j, n);
      const double t = (static_cast<double>(j) + 0.5) / static_cast<double>(n);
      all[k].minus[at] = static_cast<float>(weights.minus);
      all[k].plus[at] = static_cast<float>(weights.plus);
      all[k].limitMinus[at] = static_cast<float>((1 - t) * (1 - t) / 2);
      all[k].limitPlus[at] = static_cast<float>(t * t / 2);
      all[k].t[at] = static_cast<float>(t);
    }
  }
  return all;
}
const std::array<ColumnWeights, kMostNormalLevels + 1> kColumnWeights = makeColumnWeights();

/// A quadratic along v: the middle control value, and the differences of the previous and the next
/// one from it.
struct QuadraticRow {
  float zero, minus, plus;
  QuadraticRow(double a, double b, double c)
      : zero(static_cast<float>(b)),
        minus(static_cast<float>(a - b)),
        plus(static_cast<float>(c - b)) {}
};

/// One coordinate of a row: positions plus 1/2, for rounding by floor, and derivatives of the limit
/// surface.
struct NormalRow {
  QuadraticRow position;
  QuadraticRow alongU;
  float alongV;       // at v = 0
  float alongVSlope;  // over v

  NormalRow(const std::array<std::array<double, 3>, 3>& p, const PatchWeights& vertex, double u)
      : position(vertexAt(p, vertex, 0), vertexAt(p, vertex, 1), vertexAt(p, vertex, 2)),
        alongU(slopeAt(p, u, 0), slopeAt(p, u, 1), slopeAt(p, u, 2)) {
    const std::array<double, 3> limit = {limitAt(p, u, 0), limitAt(p, u, 1), limitAt(p, u, 2)};
    alongV = static_cast<float>(limit[1] - limit[0]);
    alongVSlope = static_cast<float>(limit[2] - 2 * limit[1] + limit[0]);
  }

 private:
  using Controls = std::array<std::array<double, 3>, 3>;
  static double vertexAt(const Controls& p, const PatchWeights& u, std::size_t v) {
    return u.minus * p[0][v] + u.zero * p[1][v] + u.plus * p[2][v] + 0.5;
  }
  static double limitAt(const Controls& p, double u, std::size_t v) {
    return p[1][v] + (1 - u) * (1 - u) / 2 * (p[0][v] - p[1][v]) + u * u / 2 * (p[2][v] - p[1][v]);
  }
  static double slopeAt(const Controls& p, double u, std::size_t v) {
    return (1 - u) * (p[1][v] - p[0][v]) + u * (p[2][v] - p[1][v]);
  }
};

}  // namespace
}  // namespace vox
#endif

HWY_BEFORE_NAMESPACE();
namespace vox::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, 8>;
using DI = hn::Rebind<std::int32_t, D>;
using V = hn::Vec<D>;
using VI = hn::Vec<DI>;

HWY_INLINE V quadratic(const QuadraticRow& row, V minus, V plus) {
  const D d;
  return hn::Add(hn::Set(d, row.zero), hn::Add(hn::Mul(minus, hn::Set(d, row.minus)),
                                               hn::Mul(plus, hn::Set(d, row.plus))));
}

/// The voxels of one coordinate; `row` has 1/2 added.
HWY_INLINE VI voxelAt(const QuadraticRow& row, V minus, V plus) {
  return hn::ConvertTo(DI(), hn::Floor(quadratic(row, minus, plus)));
}

/// Index of a mark (mark_brick.h).
HWY_INLINE VI markIndex(VI x, VI y, VI z) {
  const DI d;
  const auto in = hn::Set(d, 7);
  const auto of = hn::Set(d, 24);
  const auto inLeaf = hn::Or(hn::ShiftLeft<6>(hn::And(x, in)),
                             hn::Or(hn::ShiftLeft<3>(hn::And(y, in)), hn::And(z, in)));
  const auto ofLeaf =
      hn::Or(hn::ShiftLeft<10>(hn::And(x, of)),
             hn::Or(hn::ShiftLeft<8>(hn::And(y, of)), hn::ShiftLeft<6>(hn::And(z, of))));
  return hn::Or(inLeaf, ofLeaf);
}

void addRow(const std::array<NormalRow, 3>& row, const ColumnWeights& weights, std::size_t columns,
            std::uint8_t* HWY_RESTRICT marks, VoxelMeans::BrickSum* HWY_RESTRICT sums) {
  const D d;
  const DI di;
  const std::size_t lanes = hn::Lanes(d);
  const auto one = hn::Set(d, static_cast<float>(1 << VoxelMeans::kBrickFractionBits));
  alignas(64) std::array<std::int32_t, 8> index;
  alignas(64) std::array<std::int32_t, 32> samples;
  for (std::size_t j = 0; j < columns; j += lanes) {
    const auto minus = hn::Load(d, weights.minus.data() + j);
    const auto plus = hn::Load(d, weights.plus.data() + j);
    hn::Store(
        markIndex(voxelAt(row[0].position, minus, plus), voxelAt(row[1].position, minus, plus),
                  voxelAt(row[2].position, minus, plus)),
        di, index.data());

    const auto limitMinus = hn::Load(d, weights.limitMinus.data() + j);
    const auto limitPlus = hn::Load(d, weights.limitPlus.data() + j);
    const auto t = hn::Load(d, weights.t.data() + j);
    const auto alongU = [&](std::size_t axis)
                            HWY_ATTR { return quadratic(row[axis].alongU, limitMinus, limitPlus); };
    const auto alongV = [&](std::size_t axis) HWY_ATTR {
      return hn::Add(hn::Set(d, row[axis].alongV), hn::Mul(t, hn::Set(d, row[axis].alongVSlope)));
    };
    const auto ux = alongU(0), uy = alongU(1), uz = alongU(2);
    const auto vx = alongV(0), vy = alongV(1), vz = alongV(2);
    const auto x = hn::Sub(hn::Mul(uy, vz), hn::Mul(uz, vy));
    const auto y = hn::Sub(hn::Mul(uz, vx), hn::Mul(ux, vz));
    const auto z = hn::Sub(hn::Mul(ux, vy), hn::Mul(uy, vx));
    const auto square = hn::Add(hn::Mul(x, x), hn::Add(hn::Mul(y, y), hn::Mul(z, z)));
    const auto some = hn::Gt(square, hn::Zero(d));
    const auto scale = hn::IfThenElseZero(some, hn::Div(one, hn::Sqrt(square)));
    hn::StoreInterleaved4(hn::NearestInt(hn::Mul(x, scale)), hn::NearestInt(hn::Mul(y, scale)),
                          hn::NearestInt(hn::Mul(z, scale)),
                          hn::IfThenElseZero(hn::RebindMask(di, some), hn::Set(di, 1)), di,
                          samples.data());
    for (std::size_t lane = 0; lane < lanes; ++lane) {
      const auto at = static_cast<std::size_t>(index[lane]);
      marks[at] = MarkBrick::kMarked;
      VoxelMeans::BrickSum& sum = sums[at];
      sum.x += samples[4 * lane];
      sum.y += samples[4 * lane + 1];
      sum.z += samples[4 * lane + 2];
      sum.count += samples[4 * lane + 3];
    }
  }
}

void addTile(const TileControls& controls, int rows, int columns, std::uint8_t* marks,
             VoxelMeans::BrickSum* sums) {
  const std::int64_t n = std::int64_t{1} << rows;
  const ColumnWeights& weights = kColumnWeights[static_cast<std::size_t>(columns)];
  for (std::int64_t i = 0; i < n; ++i) {
    const PatchWeights vertex(i, n);
    const double u = (static_cast<double>(i) + 0.5) / static_cast<double>(n);
    const std::array<NormalRow, 3> row = {NormalRow(controls[0], vertex, u),
                                          NormalRow(controls[1], vertex, u),
                                          NormalRow(controls[2], vertex, u)};
    addRow(row, weights, std::size_t{1} << columns, marks, sums);
  }
}

}  // namespace vox::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vox {
namespace {

HWY_EXPORT(addTile);

}  // namespace

void addNormalTile(const Patch& patch, int rows, int columns, std::uint8_t* marks,
                   VoxelMeans::BrickSum* sums) {
  HWY_DYNAMIC_DISPATCH(addTile)(tileControls(patch), rows, columns, marks, sums);
}

}  // namespace vox
#endif
