// Triangle scan conversion with one block of 4 x 4 x 4 voxels per vector lane.
//
// The inequalities are those of scan_large.cpp. All numbers are integers below 2^53 in doubles: so
// they are exact, and the same on every processor. A triangle is at most 16 voxels across, 2^20
// lattice steps, so normals (areas of projections) stay within 2^40. Corners are within 2^20.1
// steps of the block, and the largest terms, the two parts of n.corner, within 3 * 2^50.1.

#include "libvox/voxelize/scan_small.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "libvox/voxelize/scan_small.cpp"
#include <hwy/foreach_target.h>
// Highway's macros need this order.
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace vox::detail::HWY_NAMESPACE {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

using D = hn::ScalableTag<double>;
using V = hn::Vec<D>;
using Bits = hn::Vec<hn::RebindToUnsigned<D>>;

constexpr double kUnit = 65536;  // lattice steps per voxel
constexpr double kHalf = kUnit / 2;
constexpr double kNever = -1;  // a threshold below every magnitude

/// The triangle of lanes that have none of their own. No component of its normal is 0.
constexpr double kStandIn[3][3] = {{0, 0, 0}, {1, 2, 3}, {3, 1, 2}};

V broadcast(double x) {
  return hn::Set(D(), x);
}

/// The two axes of projection k, which is along axis k.
constexpr int axisA(int k) {
  return k == 0 ? 1 : 0;
}
constexpr int axisB(int k) {
  return k == 2 ? 1 : 2;
}

/// Triangles relative to their blocks: the centres of voxels are at 0, kUnit, 2 kUnit, ...
struct Triangles {
  V corners[3][3];  ///< [corner][axis]
  V low[3], high[3];
  V last[3];  ///< last voxel of the bounding box, counted in the block
  V normal[3];
  V planeSum;   ///< floor + ceil of n.corner / kHalf
  V planeOpen;  ///< 1 where the two differ, else 0
};

/// Edges of one projection. Edge i does not separate the box of widths padA, padB around centre
/// (a, b) from the triangle iff 2 A a + 2 B b + padA |A| + padB |B| >= level.
struct Projection {
  V normalA[3], normalB[3], level[3];
};

Projection project(const Triangles& t, int k) {
  const int a = axisA(k);
  const int b = axisB(k);
  // normal[1] is for the projection on (z, x); here it is on (x, z).
  const V side = hn::And(k == 1 ? hn::Neg(t.normal[1]) : t.normal[k], broadcast(-0.0));
  Projection p;
  for (int i = 0; i < 3; ++i) {
    const V* from = t.corners[i];
    const V* to = t.corners[(i + 1) % 3];
    p.normalA[i] = hn::Xor(hn::Sub(from[b], to[b]), side);
    p.normalB[i] = hn::Xor(hn::Sub(to[a], from[a]), side);
    const V offset = hn::Add(hn::Mul(p.normalA[i], from[a]), hn::Mul(p.normalB[i], from[b]));
    p.level[i] = hn::Ceil(hn::Mul(offset, broadcast(1 / kHalf)));
  }
  return p;
}

/// For each centre of a projection: the threshold, or kNever if the projection separates its box
/// from the triangle. N voxels per side.
template <int N>
struct Thresholds {
  V at[N][N];
};

/// Sets `row`, for the voxels along `axis`, to a negative number iff the range of the triangle does
/// not meet the segment of length `pad` around the centre of the voxel.
template <int N>
void meetsRange(const Triangles& t, int axis, int pad, V (&row)[N]) {
  const V half = broadcast(pad * kHalf);
  for (int i = 0; i < N; ++i) {
    const V centre = broadcast(i * kUnit);
    row[i] = hn::Min(hn::Sub(hn::Add(centre, half), t.low[axis]),
                     hn::Sub(hn::Add(t.high[axis], half), centre));
  }
}

template <int N, bool kRange>
void fill(const Triangles& t, const Projection& p, int k, int padA, int padB, V threshold,
          Thresholds<N>& thresholds) {
  V start[3], stepA[3], stepB[3];
  for (int i = 0; i < 3; ++i) {
    start[i] = hn::Neg(p.level[i]);
    if (padA != 0) start[i] = hn::Add(start[i], hn::Abs(p.normalA[i]));
    if (padB != 0) start[i] = hn::Add(start[i], hn::Abs(p.normalB[i]));
    stepA[i] = hn::Add(p.normalA[i], p.normalA[i]);
    stepB[i] = hn::Add(p.normalB[i], p.normalB[i]);
  }
  V rangeA[N], rangeB[N];
  if (kRange) {
    meetsRange<N>(t, axisA(k), padA, rangeA);
    meetsRange<N>(t, axisB(k), padB, rangeB);
  }
  for (int a = 0; a < N; ++a) {
    V e0 = start[0];
    V e1 = start[1];
    V e2 = start[2];
    for (int b = 0; b < N; ++b) {
      V least = hn::Min(hn::Min(e0, e1), e2);
      if (kRange) least = hn::Min(least, hn::Min(rangeA[a], rangeB[b]));
      thresholds.at[a][b] =
          hn::IfThenElse(hn::Ge(least, hn::Zero(D())), threshold, broadcast(kNever));
      e0 = hn::Add(e0, stepB[0]);
      e1 = hn::Add(e1, stepB[1]);
      e2 = hn::Add(e2, stepB[2]);
    }
    for (int i = 0; i < 3; ++i) start[i] = hn::Add(start[i], stepA[i]);
  }
}

/// Bits of the voxels whose centre c is within a threshold of the plane:
/// |4 n.c - planeSum| <= threshold(x, y, z).
template <int N, class Threshold>
Bits nearPlane(const Triangles& t, const Threshold& threshold) {
  const hn::RebindToUnsigned<D> du;
  const V four = broadcast(4);
  const V step[3] = {hn::Mul(four, t.normal[0]), hn::Mul(four, t.normal[1]),
                     hn::Mul(four, t.normal[2])};
  Bits voxels = hn::Zero(du);
  V atX = hn::Neg(t.planeSum);
  for (int x = 0; x < N; ++x) {
    V atY = atX;
    for (int y = 0; y < N; ++y) {
      V at = atY;
      for (int z = 0; z < N; ++z) {
        const auto active = hn::Le(hn::Abs(at), threshold(x, y, z));
        const Bits bit = hn::Set(du, std::uint64_t{1} << (16 * x + 4 * y + z));
        voxels = hn::Or(voxels, hn::IfThenElseZero(hn::RebindMask(du, active), bit));
        at = hn::Add(at, step[2]);
      }
      atY = hn::Add(atY, step[1]);
    }
    atX = hn::Add(atX, step[0]);
  }
  return voxels;
}

/// Threshold of nearPlane for boxes of half widths t: 2 size - planeOpen with size = t.|n|.
V planeThreshold(const Triangles& t, V size) {
  return hn::Sub(hn::Add(size, size), t.planeOpen);
}

template <int N>
Bits scan26(const Triangles& t) {
  const V threshold = planeThreshold(
      t, hn::Add(hn::Add(hn::Abs(t.normal[0]), hn::Abs(t.normal[1])), hn::Abs(t.normal[2])));
  Thresholds<N> along[3];
  for (int k = 0; k < 3; ++k) fill<N, false>(t, project(t, k), k, 1, 1, threshold, along[k]);
  Bits voxels = nearPlane<N>(t, [&](int x, int y, int z) {
    return hn::Min(along[0].at[y][z], hn::Min(along[1].at[x][z], along[2].at[x][y]));
  });

  // The block begins at the first voxel that the box of the triangle meets; it may end behind the
  // last one.
  const hn::RebindToUnsigned<D> du;
  constexpr std::uint64_t kSlabs[3] = {0xffff, 0x000f000f000f000f, 0x1111111111111111};
  for (int axis = 0; axis < 3; ++axis)
    for (int i = 1; i < N; ++i) {
      const auto beyond = hn::RebindMask(du, hn::Lt(t.last[axis], broadcast(i)));
      const std::uint64_t slab = kSlabs[axis] << (i << (4 - 2 * axis));
      voxels = hn::AndNot(hn::IfThenElseZero(beyond, hn::Set(du, slab)), voxels);
    }
  return voxels;
}

/// Precondition: no component of any normal is 0. Then the plane crosses the line of each segment,
/// and besides the plane only the projection along the segment has to be tested.
template <int N>
Bits scan6(const Triangles& t) {
  Thresholds<N> along[3];
  for (int k = 0; k < 3; ++k)
    fill<N, false>(t, project(t, k), k, 0, 0, planeThreshold(t, hn::Abs(t.normal[k])), along[k]);
  return nearPlane<N>(t, [&](int x, int y, int z) {
    return hn::Max(along[0].at[y][z], hn::Max(along[1].at[x][z], along[2].at[x][y]));
  });
}

/// For any triangles: tests all inequalities for each of the three segments.
template <int N>
Bits scan6Flat(const Triangles& t) {
  Thresholds<N> along[3][3];  // [segment along][projection along]
  for (int k = 0; k < 3; ++k) {
    const Projection p = project(t, k);
    for (int s = 0; s < 3; ++s)
      fill<N, true>(t, p, k, s == axisA(k), s == axisB(k), planeThreshold(t, hn::Abs(t.normal[s])),
                    along[s][k]);
  }
  return nearPlane<N>(t, [&](int x, int y, int z) {
    V most = broadcast(kNever);
    for (int s = 0; s < 3; ++s)
      most = hn::Max(
          most, hn::Min(along[s][0].at[y][z], hn::Min(along[s][1].at[x][z], along[s][2].at[x][y])));
    return most;
  });
}

template <int N>
Bits scanBlocks(const Triangles& t, Separation separation) {
  if (separation == Separation::k26) return scan26<N>(t);
  const V least =
      hn::Min(hn::Min(hn::Abs(t.normal[0]), hn::Abs(t.normal[1])), hn::Abs(t.normal[2]));
  return hn::AllFalse(D(), hn::Eq(least, hn::Zero(D()))) ? scan6<N>(t) : scan6Flat<N>(t);
}

/// Sets the plane through corner 0: floor and ceil of n.corner / kHalf, computed in parts that
/// doubles can hold.
void finishPlane(Triangles& t) {
  for (int axis = 0; axis < 3; ++axis) {
    const int a = (axis + 1) % 3;
    const int b = (axis + 2) % 3;
    t.normal[axis] = hn::Sub(hn::Mul(hn::Sub(t.corners[1][a], t.corners[0][a]),
                                     hn::Sub(t.corners[2][b], t.corners[0][b])),
                             hn::Mul(hn::Sub(t.corners[1][b], t.corners[0][b]),
                                     hn::Sub(t.corners[2][a], t.corners[0][a])));
  }
  constexpr double kPart = 1024;
  constexpr double kRest = kHalf / kPart;
  V high = hn::Zero(D());
  V low = hn::Zero(D());
  for (int axis = 0; axis < 3; ++axis) {
    const V part = hn::Floor(hn::Mul(t.corners[0][axis], broadcast(1 / kPart)));
    const V rest = hn::Sub(t.corners[0][axis], hn::Mul(part, broadcast(kPart)));
    high = hn::Add(high, hn::Mul(t.normal[axis], part));
    low = hn::Add(low, hn::Mul(t.normal[axis], rest));
  }
  const V carried = hn::Floor(hn::Mul(low, broadcast(1 / kPart)));
  const V parts = hn::Add(high, carried);
  const V floor = hn::Floor(hn::Mul(parts, broadcast(1 / kRest)));
  const auto whole = hn::And(hn::Eq(hn::Mul(carried, broadcast(kPart)), low),
                             hn::Eq(hn::Mul(floor, broadcast(kRest)), parts));
  t.planeOpen = hn::IfThenZeroElse(whole, broadcast(1));
  t.planeSum = hn::Add(hn::Add(floor, floor), t.planeOpen);
}

void scanVector(SmallScan& scan, std::size_t first, Separation separation) {
  const D d;
  const hn::RebindToUnsigned<D> du;
  Triangles t;
  V reach = hn::Zero(d);
  V mostAcross = hn::Zero(d);
  V mostLast = hn::Zero(d);
  V origin[3];
  for (int axis = 0; axis < 3; ++axis) {
    V* const c[3] = {&t.corners[0][axis], &t.corners[1][axis], &t.corners[2][axis]};
    for (int i = 0; i < 3; ++i) {
      const V position = hn::Load(d, scan.corners[3 * i + axis].data() + first);
      *c[i] = hn::Round(hn::Mul(position, broadcast(kUnit)));
      reach = hn::Max(reach, hn::Abs(*c[i]));
    }
    t.low[axis] = hn::Min(hn::Min(*c[0], *c[1]), *c[2]);
    t.high[axis] = hn::Max(hn::Max(*c[0], *c[1]), *c[2]);
    const V begin =
        hn::Floor(hn::Mul(hn::Add(t.low[axis], broadcast(kHalf - 1)), broadcast(1 / kUnit)));
    const V end = hn::Floor(hn::Mul(hn::Add(t.high[axis], broadcast(kHalf)), broadcast(1 / kUnit)));
    const V across = hn::Sub(end, begin);
    const V offset = hn::Load(d, scan.offset[axis].data() + first);
    origin[axis] = hn::Add(begin, offset);
    t.last[axis] = hn::Sub(across, offset);
    mostAcross = hn::Max(mostAcross, across);
    mostLast = hn::Max(mostLast, t.last[axis]);
    hn::Store(across, d, scan.across[axis].data() + first);
  }
  auto fits = hn::And(hn::Le(mostAcross, broadcast(kSmallAcross - 1)),
                      hn::Le(reach, broadcast(kUnit * (1 << 30))));
  for (int i = 0; i < 3; ++i)
    for (int axis = 0; axis < 3; ++axis)
      fits = hn::And(fits, hn::Eq(t.corners[i][axis], t.corners[i][axis]));
  hn::Store(hn::IfThenElseZero(hn::RebindMask(du, fits), hn::Set(du, 1)), du,
            scan.fits.data() + first);
  for (int axis = 0; axis < 3; ++axis) {
    hn::Store(hn::IfThenElseZero(fits, origin[axis]), d, scan.origin[axis].data() + first);
    const V shift = hn::Mul(origin[axis], broadcast(kUnit));
    for (int i = 0; i < 3; ++i)
      t.corners[i][axis] =
          hn::IfThenElse(fits, hn::Sub(t.corners[i][axis], shift), broadcast(kStandIn[i][axis]));
    t.low[axis] = hn::Sub(t.low[axis], shift);
    t.high[axis] = hn::Sub(t.high[axis], shift);
  }
  finishPlane(t);
  const auto within3 = hn::Le(hn::IfThenElseZero(fits, mostLast), broadcast(2));
  const Bits voxels =
      hn::AllTrue(d, within3) ? scanBlocks<3>(t, separation) : scanBlocks<4>(t, separation);
  hn::Store(voxels, du, scan.voxels.data() + first);
}

void scanSmall(SmallScan& scan, std::size_t count, Separation separation) {
  for (std::size_t first = 0; first < count; first += hn::Lanes(D()))
    scanVector(scan, first, separation);
}

}  // namespace
}  // namespace vox::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vox::detail {

HWY_EXPORT(scanSmall);

void scanSmall(SmallScan& scan, std::size_t count, Separation separation) {
  HWY_DYNAMIC_DISPATCH(scanSmall)(scan, count, separation);
}

}  // namespace vox::detail
#endif
