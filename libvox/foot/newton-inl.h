// Newton's method for the foot of several points, a point in each lane.

// Highway includes this file once per instruction set.
#if defined(LIBVOX_FOOT_NEWTON_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef LIBVOX_FOOT_NEWTON_INL_H
#undef LIBVOX_FOOT_NEWTON_INL_H
#else
#define LIBVOX_FOOT_NEWTON_INL_H
#endif

#include "libvox/foot/biquadratic.h"
#include "libvox/foot/star_fit.h"

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace vox::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<float, 8>;
using V = hn::Vec<D>;
using V3 = std::array<V, 3>;

HWY_INLINE V set(float x) {
  return hn::Set(D(), x);
}
/// a b + c, rounded twice: the same bits with and without fused instructions.
HWY_INLINE V mulAdd(V a, V b, V c) {
  return hn::Add(hn::Mul(a, b), c);
}
HWY_INLINE V dot3(const V3& a, const V3& b) {
  return mulAdd(a[0], b[0], mulAdd(a[1], b[1], hn::Mul(a[2], b[2])));
}
/// a[0] x[0] + a[1] x[1] + a[2] x[2].
HWY_INLINE V along(const Float3& a, const V3& x) {
  return mulAdd(set(a[0]), x[0], mulAdd(set(a[1]), x[1], hn::Mul(set(a[2]), x[2])));
}

/// Position and derivatives at parameters a, b.
struct JetV {
  V3 s, sa, sb;
};
HWY_INLINE void jetAt(const Biquadratic& c, V a, V b, JetV& jet) {
  const V a2 = hn::Add(a, a);
  const V b2 = hn::Add(b, b);
  for (std::size_t x = 0; x < 3; ++x) {
    const V r0 = mulAdd(a, mulAdd(a, set(c[2][x]), set(c[1][x])), set(c[0][x]));
    const V r1 = mulAdd(a, mulAdd(a, set(c[5][x]), set(c[4][x])), set(c[3][x]));
    const V r2 = mulAdd(a, mulAdd(a, set(c[8][x]), set(c[7][x])), set(c[6][x]));
    const V d0 = mulAdd(a2, set(c[2][x]), set(c[1][x]));
    const V d1 = mulAdd(a2, set(c[5][x]), set(c[4][x]));
    const V d2 = mulAdd(a2, set(c[8][x]), set(c[7][x]));
    jet.s[x] = mulAdd(b, mulAdd(b, r2, r1), r0);
    jet.sb[x] = mulAdd(b2, r2, r1);
    jet.sa[x] = mulAdd(b, mulAdd(b, d2, d1), d0);
  }
}
HWY_INLINE V3 cross3(const V3& a, const V3& b) {
  const auto component = [&](std::size_t i, std::size_t j) {
    return hn::Sub(hn::Mul(a[i], b[j]), hn::Mul(a[j], b[i]));
  };
  return {component(1, 2), component(2, 0), component(0, 1)};
}

/// Value and derivatives of a polynomial.
struct QuarticJetV {
  V value, a, b, halfAa, ab, halfBb;
};
/// A value, its derivative, and half of the second one, by Horner's scheme.
template <std::size_t n>
HWY_INLINE V3 horner(const std::array<V, n>& terms, V x) {
  V value = mulAdd(terms[n - 1], x, terms[n - 2]);
  V half = terms[n - 1];
  V first = mulAdd(half, x, value);
  value = mulAdd(value, x, terms[n - 3]);
  for (std::size_t i = n - 3; i-- > 0;) {
    half = mulAdd(half, x, first);
    first = mulAdd(first, x, value);
    value = mulAdd(value, x, terms[i]);
  }
  return {value, first, half};
}
HWY_INLINE void jetAt(const Quartic<V>& c, V a, V b, QuarticJetV& jet) {
  const V3 r0 = horner<5>({c[0], c[1], c[2], c[3], c[4]}, a);
  const V3 r1 = horner<4>({c[5], c[6], c[7], c[8]}, a);
  const V3 r2 = horner<3>({c[9], c[10], c[11]}, a);
  const V3 values = horner<5>({r0[0], r1[0], r2[0], mulAdd(c[13], a, c[12]), c[14]}, b);
  const V3 alongA = horner<4>({r0[1], r1[1], r2[1], c[13]}, b);
  jet = {values[0], alongA[0], values[1], mulAdd(mulAdd(r2[2], b, r1[2]), b, r0[2]),
         alongA[1], values[2]};
}

/// Half the second derivatives of a square of a distance, as if the surface were flat and as it is;
/// and half its gradient, downward.
struct DescentTerms {
  V flatAa, flatAb, flatBb;
  V aa, ab, bb;
  V downA, downB;
};

/// One step down with |a| <= limitA, |b| <= limitB: of Newton's method, or where the Hessian is not
/// safely positive one of the Gauss-Newton method.
/// @return the larger change of a and b
HWY_INLINE V stepDown(const DescentTerms& terms, V limitA, V limitB, V& a, V& b) {
  V haa = terms.aa, hab = terms.ab, hbb = terms.bb;
  const V e = terms.flatAa, f = terms.flatAb, g = terms.flatBb;
  V det = hn::Sub(hn::Mul(haa, hbb), hn::Mul(hab, hab));
  const V detFlat = hn::Sub(hn::Mul(e, g), hn::Mul(f, f));
  const auto safe =
      hn::And(hn::Gt(det, hn::Mul(set(0.02F), detFlat)), hn::Gt(haa, hn::Mul(set(0.05F), e)));
  haa = hn::IfThenElse(safe, haa, e);
  hbb = hn::IfThenElse(safe, hbb, g);
  hab = hn::IfThenElse(safe, hab, f);
  const V tiny = set(1e-30F);
  const V least = mulAdd(hn::Mul(set(1e-6F), e), g, tiny);
  det = hn::IfThenElse(safe, hn::Max(det, tiny), hn::Max(detFlat, least));
  const auto within = [](V p, V limit) { return hn::Min(hn::Max(p, hn::Neg(limit)), limit); };
  const V stepA = hn::Div(hn::Sub(hn::Mul(hbb, terms.downA), hn::Mul(hab, terms.downB)), det);
  // Each parameter once more, given the other one within its limits.
  V na = within(hn::Add(a, stepA), limitA);
  const V nb = within(
      hn::Add(b, hn::Div(hn::Sub(terms.downB, hn::Mul(hab, hn::Sub(na, a))), hn::Max(hbb, tiny))),
      limitB);
  na = within(
      hn::Add(a, hn::Div(hn::Sub(terms.downA, hn::Mul(hab, hn::Sub(nb, b))), hn::Max(haa, tiny))),
      limitA);
  const V change = hn::Max(hn::Abs(hn::Sub(na, a)), hn::Abs(hn::Sub(nb, b)));
  a = na;
  b = nb;
  return change;
}

/// One step of Newton's method for the least |x - S(a, b)|^2 with |a|, |b| <= limit (stepDown).
/// @return the larger change of a and b
HWY_INLINE V newtonStep(const Biquadratic& c, const V3& x, V limit, V& a, V& b) {
  const V a2 = hn::Add(a, a);
  const V b2 = hn::Add(b, b);
  const V zero = hn::Zero(D());
  V e = zero, f = zero, g = zero, ra = zero, rb = zero, raa = zero, rab = zero, rbb = zero;
  for (std::size_t k = 0; k < 3; ++k) {
    const V r0 = mulAdd(a, mulAdd(a, set(c[2][k]), set(c[1][k])), set(c[0][k]));
    const V r1 = mulAdd(a, mulAdd(a, set(c[5][k]), set(c[4][k])), set(c[3][k]));
    const V r2 = mulAdd(a, mulAdd(a, set(c[8][k]), set(c[7][k])), set(c[6][k]));
    const V d0 = mulAdd(a2, set(c[2][k]), set(c[1][k]));
    const V d1 = mulAdd(a2, set(c[5][k]), set(c[4][k]));
    const V d2 = mulAdd(a2, set(c[8][k]), set(c[7][k]));
    const V s = mulAdd(b, mulAdd(b, r2, r1), r0);
    const V sb = mulAdd(b2, r2, r1);
    const V sa = mulAdd(b, mulAdd(b, d2, d1), d0);
    const V sab = mulAdd(b2, d2, d1);
    const V saaHalf = mulAdd(b, mulAdd(b, set(c[8][k]), set(c[5][k])), set(c[2][k]));
    const V r = hn::Sub(x[k], s);
    e = mulAdd(sa, sa, e);
    f = mulAdd(sa, sb, f);
    g = mulAdd(sb, sb, g);
    ra = mulAdd(r, sa, ra);
    rb = mulAdd(r, sb, rb);
    raa = mulAdd(r, saaHalf, raa);
    rab = mulAdd(r, sab, rab);
    rbb = mulAdd(r, r2, rbb);
  }
  const DescentTerms terms = {
      e,  f, g, hn::Sub(e, hn::Add(raa, raa)), hn::Sub(f, rab), hn::Sub(g, hn::Add(rbb, rbb)),
      ra, rb};
  return stepDown(terms, limit, limit, a, b);
}

}  // namespace vox::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
