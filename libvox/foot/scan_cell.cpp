// Feet of voxels by Newton's method, and by the polynomials of a cell.

// Highway compiles this file once per instruction set, between HWY_BEFORE_ and HWY_AFTER_NAMESPACE.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "libvox/foot/scan_cell.cpp"
#include "libvox/foot/scan_cell.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

// clang-format off
#include "libvox/foot/newton-inl.h"  // after foreach_target.h: once per instruction set
// clang-format on

#include <algorithm>
#include <array>
#include <bit>

HWY_BEFORE_NAMESPACE();
namespace vox::HWY_NAMESPACE {

/// Steps of Newton's method from a, b on. A lane that has arrived stays where it is, so that it
/// does not depend on the others.
HWY_INLINE void descend(const NewtonCell& cell, const V3& x, V& a, V& b) {
  const D d;
  const V one = set(1);
  const V stop = set(cell.stop);
  auto moving = hn::Eq(one, one);
  for (int step = 0; step < cell.mostSteps && !hn::AllFalse(d, moving); ++step) {
    V nextA = a;
    V nextB = b;
    const V change = newtonStep(cell.surface, x, one, nextA, nextB);
    a = hn::IfThenElse(moving, nextA, a);
    b = hn::IfThenElse(moving, nextB, b);
    moving = hn::And(moving, hn::Gt(change, stop));
  }
}

HWY_INLINE V squareDistance(const Biquadratic& surface, const V3& x, V a, V b) {
  JetV jet;
  jetAt(surface, a, b, jet);
  const V3 r = {hn::Sub(x[0], jet.s[0]), hn::Sub(x[1], jet.s[1]), hn::Sub(x[2], jet.s[2])};
  return dot3(r, r);
}

/// A normal at a, b, of any length; in cells at creases the one a little farther in.
/// @param jet  at a, b
HWY_INLINE V3 normalAt(const NewtonCell& cell, V a, V b, const JetV& jet) {
  if (cell.creaseBias == 0) return cross3(jet.sa, jet.sb);
  const V in = set(kBesideCorner);
  JetV inner;
  jetAt(cell.surface, hn::Mul(in, a), hn::Mul(in, b), inner);
  return cross3(inner.sa, inner.sb);
}

/// At a crease both sides have the same foot. The side to which the point lies more upright tells
/// its sign, so the other one counts as a little farther.
/// @param side    product of the way from the foot to the point, and of a normal
/// @param r2, n2  squares of their lengths
HWY_INLINE V withBias(float bias, V distance, V side, V r2, V n2) {
  const V one = set(1);
  const V tiny = set(1e-30F);
  const V upright2 = hn::Div(hn::Div(hn::Mul(side, side), hn::Max(n2, tiny)), hn::Max(r2, tiny));
  return mulAdd(set(bias), hn::Sub(one, hn::Sqrt(hn::Min(upright2, one))), distance);
}

void solve(const NewtonCell& cell, const Float3& shift, Feet& feet) {
  const D d;
  const std::size_t lanes = hn::Lanes(d);
  const V one = set(1);
  const auto within = [&](V p) { return hn::Min(hn::Max(p, hn::Neg(one)), one); };
  for (std::size_t i = 0; i < feet.count; i += lanes) {
    const V3 x = {hn::Sub(hn::Load(d, feet.x.data() + i), set(shift[0])),
                  hn::Sub(hn::Load(d, feet.y.data() + i), set(shift[1])),
                  hn::Sub(hn::Load(d, feet.z.data() + i), set(shift[2]))};
    const V3 fromMiddle = {hn::Sub(x[0], set(cell.surface[0][0])),
                           hn::Sub(x[1], set(cell.surface[0][1])),
                           hn::Sub(x[2], set(cell.surface[0][2]))};
    V a = within(along(cell.guess[0], fromMiddle));
    V b = within(along(cell.guess[1], fromMiddle));
    descend(cell, x, a, b);
    if (cell.severalStarts) {
      V least = squareDistance(cell.surface, x, a, b);
      for (const float startA : {-0.6F, 0.6F})
        for (const float startB : {-0.6F, 0.6F}) {
          V otherA = set(startA);
          V otherB = set(startB);
          descend(cell, x, otherA, otherB);
          const V other = squareDistance(cell.surface, x, otherA, otherB);
          const auto nearer = hn::Lt(other, least);
          a = hn::IfThenElse(nearer, otherA, a);
          b = hn::IfThenElse(nearer, otherB, b);
          least = hn::Min(other, least);
        }
    }
    JetV jet;
    jetAt(cell.surface, a, b, jet);
    const V3 n = normalAt(cell, a, b, jet);
    const V3 r = {hn::Sub(x[0], jet.s[0]), hn::Sub(x[1], jet.s[1]), hn::Sub(x[2], jet.s[2])};
    const V side = dot3(r, n);
    const V n2 = dot3(n, n);
    const V r2 = dot3(r, r);
    // Inside the cell a small rest along the surface is an error of the method, not distance.
    const V t2 = hn::Div(hn::Mul(side, side), hn::Max(n2, set(1e-30F)));
    const auto inside =
        hn::And(hn::Lt(hn::Max(hn::Abs(a), hn::Abs(b)), one),
                hn::And(hn::Lt(set(1e-12F), n2), hn::Lt(hn::Sub(r2, t2), set(0.04F))));
    const V nearest = hn::Sqrt(hn::IfThenElse(inside, hn::Min(t2, r2), r2));
    const V distance = withBias(cell.creaseBias, nearest, side, r2, n2);
    hn::Store(hn::CopySign(distance, side), d, feet.t.data() + i);
    hn::Store(a, d, feet.a.data() + i);
    hn::Store(b, d, feet.b.data() + i);
  }
}

/// One step of Newton's method for a height (stepDown).
/// @param x  in the frame of the height
/// @return the larger change of a and b
HWY_INLINE V heightStep(const Quartic<V>& height, const V3& x, const std::array<V, 2>& half, V& a,
                        V& b) {
  const V one = set(1);
  QuarticJetV jet;
  jetAt(height, a, b, jet);
  const V rise = hn::Sub(x[2], jet.value);
  const V twice = hn::Add(rise, rise);
  const V e = mulAdd(jet.a, jet.a, one), g = mulAdd(jet.b, jet.b, one), f = hn::Mul(jet.a, jet.b);
  const DescentTerms terms = {e,
                              f,
                              g,
                              hn::Sub(e, hn::Mul(twice, jet.halfAa)),
                              hn::Sub(f, hn::Mul(rise, jet.ab)),
                              hn::Sub(g, hn::Mul(twice, jet.halfBb)),
                              mulAdd(rise, jet.a, hn::Sub(x[0], a)),
                              mulAdd(rise, jet.b, hn::Sub(x[1], b))};
  return stepDown(terms, half[0], half[1], a, b);
}

void solveHeight(const HeightCell& cell, const Float3& shift, Feet& feet) {
  constexpr int kMostSteps = 6;
  const D d;
  const V one = set(1);
  Quartic<V> height;
  for (std::size_t i = 0; i < height.size(); ++i) height[i] = set(cell.height[i]);
  const std::array<V, 2> half = {set(cell.half[0]), set(cell.half[1])};
  const V stop = set(cell.stop);
  Float3 middle;
  for (std::size_t k = 0; k < 3; ++k) middle[k] = shift[k] + cell.middle[k];
  for (std::size_t i = 0; i < feet.count; i += hn::Lanes(d)) {
    const V3 from = {hn::Sub(hn::Load(d, feet.x.data() + i), set(middle[0])),
                     hn::Sub(hn::Load(d, feet.y.data() + i), set(middle[1])),
                     hn::Sub(hn::Load(d, feet.z.data() + i), set(middle[2]))};
    const V3 x = {along(cell.axes[0], from), along(cell.axes[1], from), along(cell.axes[2], from)};
    V a = hn::Min(hn::Max(x[0], hn::Neg(half[0])), half[0]);
    V b = hn::Min(hn::Max(x[1], hn::Neg(half[1])), half[1]);
    auto moving = hn::Eq(one, one);
    for (int step = 0; step < kMostSteps && !hn::AllFalse(d, moving); ++step) {
      V nextA = a, nextB = b;
      const V change = heightStep(height, x, half, nextA, nextB);
      a = hn::IfThenElse(moving, nextA, a);
      b = hn::IfThenElse(moving, nextB, b);
      moving = hn::And(moving, hn::Gt(change, stop));
    }
    // A foot beyond the sides is brought back: a neighbour has a nearer one, or the normals of both
    // are off a little.
    auto inside = hn::And(hn::Lt(hn::Abs(a), half[0]), hn::Lt(hn::Abs(b), half[1]));
    for (std::size_t s = 0; s < cell.sideCount; ++s) {
      const auto& [sa, sb, most] = cell.sides[s];
      const V out = mulAdd(set(sa), a, mulAdd(set(sb), b, set(-most)));
      const V beyond = hn::Max(out, hn::Zero(d));
      a = hn::Sub(a, hn::Mul(set(sa), beyond));
      b = hn::Sub(b, hn::Mul(set(sb), beyond));
      inside = hn::And(inside, hn::Le(out, hn::Zero(d)));
    }
    a = hn::Min(hn::Max(a, hn::Neg(half[0])), half[0]);
    b = hn::Min(hn::Max(b, hn::Neg(half[1])), half[1]);
    QuarticJetV jet;
    jetAt(height, a, b, jet);
    const V ra = hn::Sub(x[0], a), rb = hn::Sub(x[1], b), rise = hn::Sub(x[2], jet.value);
    const V side = hn::Sub(rise, mulAdd(ra, jet.a, hn::Mul(rb, jet.b)));
    const V n2 = mulAdd(jet.a, jet.a, mulAdd(jet.b, jet.b, one));
    const V r2 = mulAdd(ra, ra, mulAdd(rb, rb, hn::Mul(rise, rise)));
    // As in solve.
    const V t2 = hn::Div(hn::Mul(side, side), n2);
    const auto near = hn::And(inside, hn::Lt(hn::Sub(r2, t2), set(0.04F)));
    const V distance = hn::Sqrt(hn::IfThenElse(near, hn::Min(t2, r2), r2));
    hn::Store(hn::CopySign(distance, side), d, feet.t.data() + i);
    hn::Store(a, d, feet.a.data() + i);
    hn::Store(b, d, feet.b.data() + i);
  }
}

/// The nearest point of a triangle, by the region in which its projection lies.
/// Source: Ericson, Real-Time Collision Detection, 2005, section 5.1.5.
void solveTriangle(const TriangleCell& cell, const Float3& shift, Feet& feet) {
  const D d;
  const auto& p = cell.points;
  const auto difference = [](const Float3& to, const Float3& from) -> Float3 {
    return {to[0] - from[0], to[1] - from[1], to[2] - from[2]};
  };
  const Float3 ab = difference(p[1], p[0]);
  const Float3 ac = difference(p[2], p[0]);
  const V zero = hn::Zero(d);
  const V one = set(1);
  for (std::size_t i = 0; i < feet.count; i += hn::Lanes(d)) {
    const V3 x = {hn::Sub(hn::Load(d, feet.x.data() + i), set(shift[0])),
                  hn::Sub(hn::Load(d, feet.y.data() + i), set(shift[1])),
                  hn::Sub(hn::Load(d, feet.z.data() + i), set(shift[2]))};
    const auto from = [&](const Float3& q) -> V3 {
      return {hn::Sub(x[0], set(q[0])), hn::Sub(x[1], set(q[1])), hn::Sub(x[2], set(q[2]))};
    };
    const V3 ax = from(p[0]), bx = from(p[1]), cx = from(p[2]);
    const V d1 = along(ab, ax), d2 = along(ac, ax);
    const V d3 = along(ab, bx), d4 = along(ac, bx);
    const V d5 = along(ab, cx), d6 = along(ac, cx);
    const V va = hn::Sub(hn::Mul(d3, d6), hn::Mul(d5, d4));
    const V vb = hn::Sub(hn::Mul(d5, d2), hn::Mul(d1, d6));
    const V vc = hn::Sub(hn::Mul(d1, d4), hn::Mul(d3, d2));
    const auto divided = [&](V a, V b) {
      return hn::Div(a, hn::IfThenElse(hn::Eq(b, zero), one, b));
    };
    const V sum = hn::Add(va, hn::Add(vb, vc));
    V v = divided(vb, sum);
    V w = divided(vc, sum);
    V3 n = {set(cell.normal[0]), set(cell.normal[1]), set(cell.normal[2])};
    const auto choose = [&](auto where, V newV, V newW, const Float3& normal) {
      v = hn::IfThenElse(where, newV, v);
      w = hn::IfThenElse(where, newW, w);
      for (std::size_t k = 0; k < 3; ++k) n[k] = hn::IfThenElse(where, set(normal[k]), n[k]);
    };
    const auto all = [](auto a, auto b, auto c) { return hn::And(a, hn::And(b, c)); };
    const V onBc = hn::Sub(d4, d3), beyondBc = hn::Sub(d5, d6);
    const V alongBc = divided(onBc, hn::Add(onBc, beyondBc));
    choose(all(hn::Le(va, zero), hn::Ge(onBc, zero), hn::Ge(beyondBc, zero)), hn::Sub(one, alongBc),
           alongBc, cell.edgeNormals[1]);
    choose(all(hn::Le(vb, zero), hn::Ge(d2, zero), hn::Le(d6, zero)), zero,
           divided(d2, hn::Sub(d2, d6)), cell.edgeNormals[2]);
    choose(all(hn::Le(vc, zero), hn::Ge(d1, zero), hn::Le(d3, zero)), divided(d1, hn::Sub(d1, d3)),
           zero, cell.edgeNormals[0]);
    choose(hn::And(hn::Ge(d6, zero), hn::Le(d5, d6)), zero, one, cell.vertexNormals[2]);
    choose(hn::And(hn::Ge(d3, zero), hn::Le(d4, d3)), one, zero, cell.vertexNormals[1]);
    choose(hn::And(hn::Le(d1, zero), hn::Le(d2, zero)), zero, zero, cell.vertexNormals[0]);
    V3 r;
    for (std::size_t k = 0; k < 3; ++k)
      r[k] = hn::Sub(ax[k], hn::Add(hn::Mul(v, set(ab[k])), hn::Mul(w, set(ac[k]))));
    const V side = dot3(r, n);
    V distance = hn::Sqrt(dot3(r, r));
    if (cell.creaseBias != 0)
      distance = withBias(cell.creaseBias, distance, side, dot3(r, r), dot3(n, n));
    hn::Store(hn::CopySign(distance, side), d, feet.t.data() + i);
    hn::Store(v, d, feet.a.data() + i);
    hn::Store(w, d, feet.b.data() + i);
  }
}

/// First and last z of the rows x, firstY, firstY + 1, ...: integers; first > last if the row has
/// no voxel. Rows outside low and high are empty.
/// @return the rows that are not empty: bit i for the i-th row
HWY_INLINE unsigned rowsAt(const PrismRows& rows, int x, int firstY, PrismRows::Group& first,
                           PrismRows::Group& last) {
  const D d;
  unsigned all = 0;
  for (std::size_t r = 0; r < PrismRows::kGroup; r += hn::Lanes(d)) {
    const V y = hn::Iota(d, static_cast<float>(firstY) + static_cast<float>(r));
    V from = set(static_cast<float>(rows.low[2]));
    V to = set(static_cast<float>(rows.high[2]));
    for (std::size_t k = 0; k < 3; ++k) {
      const V at =
          mulAdd(set(rows.perY[k]), y, set(rows.middle[k] + rows.perX[k] * static_cast<float>(x)));
      from = hn::Max(from, hn::Sub(at, set(rows.reach[k])));
      to = hn::Min(to, hn::Add(at, set(rows.reach[k])));
    }
    from = hn::Ceil(from);
    to = hn::Floor(to);
    const auto inside = hn::And(hn::And(hn::Ge(y, set(static_cast<float>(rows.low[1]))),
                                        hn::Le(y, set(static_cast<float>(rows.high[1])))),
                                hn::Le(from, to));
    hn::Store(hn::IfThenElse(inside, from, set(1)), d, first.data() + r);
    hn::Store(hn::IfThenElse(inside, to, set(0)), d, last.data() + r);
    std::array<std::uint8_t, 8> bits = {};
    hn::StoreMaskBits(d, inside, bits.data());
    all |= unsigned{bits[0]} << r;
  }
  return all;
}

/// @return whether the walk is at its end
bool gatherRows(const PrismRows& rows, RowsPlace& at, Feet& feet) {
  const D d;
  const hn::RebindToUnsigned<D> du;
  static_assert(hn::MaxLanes(D()) <= Feet::kSlack);
  constexpr std::size_t kMostOfGroup = std::size_t{PrismRows::kGroup} * kBinSide;
  alignas(64) PrismRows::Group first, last;
  std::size_t count = feet.count;
  bool isFull = false;
  for (; at.x <= rows.high[0]; ++at.x, at.y = rows.low[1]) {
    const V x = set(static_cast<float>(at.x));
    for (; at.y <= rows.high[1]; at.y += PrismRows::kGroup) {
      isFull = count + kMostOfGroup > Feet::kMost;
      if (isFull) break;
      unsigned left = rowsAt(rows, at.x, at.y, first, last);
      for (; left != 0; left &= left - 1) {
        const auto r = static_cast<std::size_t>(std::countr_zero(left));
        const auto ux = static_cast<unsigned>(at.x),
                   uy = static_cast<unsigned>(at.y) + static_cast<unsigned>(r);
        const unsigned start = leafOf(ux, uy, 0) << 9 | voxelInLeaf(ux, uy, 0);
        const V y = set(static_cast<float>(uy));
        const auto low = static_cast<unsigned>(first[r]);
        const auto voxels = static_cast<unsigned>(last[r]) - low + 1;
        for (unsigned i = 0; i < voxels; i += static_cast<unsigned>(hn::Lanes(d))) {
          const auto z = hn::Iota(du, low + i);
          const auto number =
              hn::Or(hn::Set(du, start),
                     hn::Or(hn::ShiftLeft<9>(hn::ShiftRight<3>(z)), hn::And(z, hn::Set(du, 7U))));
          hn::StoreU(x, d, feet.x.data() + count + i);
          hn::StoreU(y, d, feet.y.data() + count + i);
          hn::StoreU(hn::Iota(d, first[r] + static_cast<float>(i)), d, feet.z.data() + count + i);
          hn::StoreU(number, du, feet.voxel.data() + count + i);
        }
        count += voxels;
      }
    }
    if (isFull) break;
  }
  feet.count = count;
  return !isFull;
}

/// Terms of a cubic for fixed x: in y and z. For fixed y, too: in z.
struct Slice {
  std::array<float, 4> constant;   // of 1 y y^2 y^3
  std::array<float, 3> linear;     // of z, z y, z y^2
  std::array<float, 2> quadratic;  // of z^2, z^2 y
  Slice(const std::array<float, 20>& k, float x)
      : constant{k[0] + x * (k[1] + x * (k[4] + x * k[10])), k[2] + x * (k[5] + x * k[11]),
                 k[7] + x * k[13], k[16]},
        linear{k[3] + x * (k[6] + x * k[12]), k[8] + x * k[14], k[17]},
        quadratic{k[9] + x * k[15], k[18]} {}
};

struct RowTerms {
  alignas(64) std::array<PrismRows::Group, 3> constant;
  alignas(64) std::array<PrismRows::Group, 3> linear;
  alignas(64) std::array<PrismRows::Group, 3> quadratic;
};

/// Terms in z of eight rows.
HWY_INLINE void setRows(const std::array<Slice, 3>& slices, float firstY, RowTerms& terms) {
  const D d;
  for (std::size_t i = 0; i < PrismRows::kGroup; i += hn::Lanes(d)) {
    const V y = hn::Add(hn::Iota(d, static_cast<float>(i)), set(firstY));
    for (std::size_t f = 0; f < 3; ++f) {
      const Slice& s = slices[f];
      const auto& c = s.constant;
      hn::Store(mulAdd(y, mulAdd(y, mulAdd(y, set(c[3]), set(c[2])), set(c[1])), set(c[0])), d,
                terms.constant[f].data() + i);
      hn::Store(mulAdd(y, mulAdd(y, set(s.linear[2]), set(s.linear[1])), set(s.linear[0])), d,
                terms.linear[f].data() + i);
      hn::Store(mulAdd(y, set(s.quadratic[1]), set(s.quadratic[0])), d,
                terms.quadratic[f].data() + i);
    }
  }
}

void scan(const PolynomialCell& cell, const openvdb::Coord& binOrigin, std::uint32_t signMask,
          const VoxelFloors* floors, FootBrick& brick) {
  const D d;
  const hn::RebindToUnsigned<D> du;
  const PrismRows rows(cell.prism, binOrigin);
  if (rows.empty()) return;
  const V limitA = set(cell.limitA);
  const V limitB = set(cell.limitB);
  const auto keptBits = hn::Set(du, signMask);
  const int z8First = rows.low[2] >> 3;
  const int z8Last = rows.high[2] >> 3;
  alignas(64) PrismRows::Group first, last;
  RowTerms terms;
  for (int x = rows.low[0]; x <= rows.high[0]; ++x) {
    const float fromCentre = static_cast<float>(x) - rows.centre[0];
    const std::array<Slice, 3> slices = {Slice(cell.terms[0], fromCentre),
                                         Slice(cell.terms[1], fromCentre),
                                         Slice(cell.terms[2], fromCentre)};
    for (int y8 = rows.low[1] >> 3; y8 <= rows.high[1] >> 3; ++y8) {
      rowsAt(rows, x, 8 * y8, first, last);
      bool set8 = false;
      for (int z8 = z8First; z8 <= z8Last; ++z8) {
        const auto z0 = static_cast<float>(8 * z8);
        std::uint32_t* leaf = nullptr;
        const auto number = static_cast<unsigned>((x >> 3) << 4 | y8 << 2 | z8);
        for (std::size_t r = 0; r < PrismRows::kGroup; ++r) {
          if (first[r] > z0 + 7 || last[r] < z0 || first[r] > last[r]) continue;
          if (!set8) setRows(slices, static_cast<float>(8 * y8) - rows.centre[1], terms);
          set8 = true;
          if (leaf == nullptr) leaf = brick.leaf(number) + ((x & 7) << 6);
          for (std::size_t i = 0; i < 8; i += hn::Lanes(d)) {
            const V zBin = hn::Iota(d, z0 + static_cast<float>(i));
            const V z = hn::Sub(zBin, set(rows.centre[2]));
            const auto cubic = [&](std::size_t f) {
              return mulAdd(z,
                            mulAdd(z, mulAdd(z, set(cell.terms[f][19]), set(terms.quadratic[f][r])),
                                   set(terms.linear[f][r])),
                            set(terms.constant[f][r]));
            };
            const auto inRow = hn::And(hn::Ge(zBin, set(first[r])), hn::Le(zBin, set(last[r])));
            const auto inCell =
                hn::And(hn::Le(hn::Abs(cubic(1)), limitA), hn::Le(hn::Abs(cubic(2)), limitB));
            const auto bits = hn::And(hn::BitCast(du, cubic(0)), keptBits);
            const auto key = hn::Or(hn::ShiftLeft<1>(bits), hn::ShiftRight<31>(bits));
            auto accepted = hn::RebindMask(du, hn::And(inRow, inCell));
            if (floors != nullptr) {
              const std::uint32_t* floor = (*floors)[number].data() + ((x & 7) << 6) + 8 * r + i;
              accepted = hn::And(accepted, hn::Eq(key, hn::Max(key, hn::LoadU(du, floor))));
            }
            std::uint32_t* at = leaf + 8 * r + i;
            const auto old = hn::Load(du, at);
            hn::Store(hn::IfThenElse(accepted, hn::Min(key, old), old), du, at);
          }
        }
      }
    }
  }
}

}  // namespace vox::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vox {
namespace {

HWY_EXPORT(solve);
HWY_EXPORT(solveHeight);
HWY_EXPORT(solveTriangle);
HWY_EXPORT(gatherRows);
HWY_EXPORT(scan);

Float3 shiftOf(const Prism& prism, const openvdb::Coord& binOrigin) {
  const openvdb::Coord shift = prism.origin - binOrigin;
  return {static_cast<float>(shift.x()), static_cast<float>(shift.y()),
          static_cast<float>(shift.z())};
}

/// Sets the places that only fill the last vector up.
void fillUp(Feet& feet) {
  for (auto* column : {&feet.x, &feet.y, &feet.z})
    std::fill_n(column->begin() + static_cast<std::ptrdiff_t>(feet.count), Feet::kSlack,
                (*column)[feet.count - 1]);
}

}  // namespace

void solveFeet(const NewtonCell& cell, const openvdb::Coord& binOrigin, Feet& feet) {
  fillUp(feet);
  HWY_DYNAMIC_DISPATCH(solve)(cell, shiftOf(cell.prism, binOrigin), feet);
}

void solveFeet(const HeightCell& cell, const openvdb::Coord& binOrigin, Feet& feet) {
  fillUp(feet);
  HWY_DYNAMIC_DISPATCH(solveHeight)(cell, shiftOf(cell.prism, binOrigin), feet);
}

void solveFeet(const TriangleCell& cell, const openvdb::Coord& binOrigin, Feet& feet) {
  fillUp(feet);
  HWY_DYNAMIC_DISPATCH(solveTriangle)(cell, shiftOf(cell.prism, binOrigin), feet);
}

bool gatherVoxels(const PrismRows& rows, RowsPlace& at, Feet& feet) {
  return HWY_DYNAMIC_DISPATCH(gatherRows)(rows, at, feet);
}

void keepWanted(const BinMask& wanted, Feet& feet) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < feet.count; ++i) {
    const std::uint32_t voxel = feet.voxel[i];
    feet.x[count] = feet.x[i];
    feet.y[count] = feet.y[i];
    feet.z[count] = feet.z[i];
    feet.voxel[count] = voxel;
    count += wanted[voxel >> 9][voxel >> 6 & 7U] >> (voxel & 63U) & 1U;
  }
  feet.count = count;
}

void scanPolynomials(const PolynomialCell& cell, const openvdb::Coord& binOrigin,
                     bool unsignedDistance, const VoxelFloors* floors, FootBrick& brick) {
  constexpr std::uint32_t kNoSign = 0x7FFFFFFF;
  HWY_DYNAMIC_DISPATCH(scan)(cell, binOrigin, unsignedDistance ? kNoSign : ~0U, floors, brick);
}

}  // namespace vox
#endif
