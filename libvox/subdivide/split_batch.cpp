// Two steps below level-1 vertices, one vertex per vector lane. All expressions are those of
// quadImage, PatchSteps and LocalSurface, so that the results have the same bits.

// Highway compiles this file once per instruction set, between HWY_BEFORE_ and HWY_AFTER_NAMESPACE.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "libvox/subdivide/split_batch.cpp"
#include "libvox/subdivide/split_batch.h"

#include "libvox/subdivide/stop.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace vox::HWY_NAMESPACE {
namespace {
namespace hn = hwy::HWY_NAMESPACE;

using SplitLanes = hn::CappedTag<double, SplitVertices::kMostAtOnce>;
using SplitV = hn::Vec<SplitLanes>;
using SplitMask = hn::Mask<SplitLanes>;

/// A coordinate of the control points around a child.
using Controls = SplitV[3][3];

HWY_INLINE SplitV times(double factor, SplitV x) {
  return hn::Mul(hn::Set(SplitLanes(), factor), x);
}

HWY_INLINE SplitV quadImageOf(SplitV at, SplitV before, SplitV after, SplitV opposite) {
  return times(1.0 / 16,
               hn::Add(hn::Add(times(9, at), times(3, hn::Add(before, after))), opposite));
}

/// Images of the corners of the quad a, b, c, d.
HWY_INLINE void imagesOfQuad(SplitV a, SplitV b, SplitV c, SplitV d, SplitV (&images)[4]) {
  images[0] = quadImageOf(a, b, d, c);
  images[1] = quadImageOf(b, a, c, d);
  images[2] = quadImageOf(c, b, d, a);
  images[3] = quadImageOf(d, a, c, b);
}

HWY_INLINE SplitV quarterOf(SplitV far, SplitV near) {
  return hn::Add(times(0.25, far), times(0.75, near));
}

/// Raises `size` to the extent of a quad.
HWY_INLINE void takeExtent(SplitV a, SplitV b, SplitV c, SplitV d, SplitV& size) {
  const SplitV low = hn::Min(hn::Min(a, b), hn::Min(c, d));
  const SplitV high = hn::Max(hn::Max(a, b), hn::Max(c, d));
  size = hn::Max(size, hn::Sub(high, low));
}

/// Raises `size` to the sum of the largest steps along u and v.
HWY_INLINE void takeSteps(const Controls& p, SplitV& size) {
  SplitV u = hn::Zero(SplitLanes());
  SplitV v = u;
  for (int b = 0; b < 3; ++b) {
    u = hn::Max(u, hn::Max(hn::Abs(hn::Sub(p[1][b], p[0][b])), hn::Abs(hn::Sub(p[2][b], p[1][b]))));
    v = hn::Max(v, hn::Max(hn::Abs(hn::Sub(p[b][1], p[b][0])), hn::Abs(hn::Sub(p[b][2], p[b][1]))));
  }
  size = hn::Max(size, hn::Add(u, v));
}

/// The extents of the quads around a corner of F or of the V-face, and its children.
HWY_INLINE void splitCorner(const Controls& p, SplitV deep, SplitV (&children)[4], SplitV& size) {
  takeExtent(p[1][1], p[2][1], p[2][0], p[1][0], size);
  takeExtent(p[1][1], p[1][2], p[0][2], p[0][1], size);
  takeExtent(p[1][1], p[1][0], p[0][0], p[0][1], size);
  children[0] = deep;
  children[1] = quadImageOf(p[1][1], p[2][1], p[1][0], p[2][0]);
  children[2] = quadImageOf(p[1][1], p[1][2], p[0][1], p[0][2]);
  children[3] = quadImageOf(p[1][1], p[1][0], p[0][1], p[0][0]);
}

/// The steps of a regular child, and its children.
HWY_INLINE void splitRegular(const Controls& p, SplitV (&children)[4], SplitV& size) {
  takeSteps(p, size);
  for (int a : {0, 2}) {
    const SplitV middle = quarterOf(p[a][1], p[1][1]);
    children[a] = quarterOf(quarterOf(p[a][0], p[1][0]), middle);
    children[a + 1] = quarterOf(quarterOf(p[a][2], p[1][2]), middle);
  }
}

/// The lanes of a mask as bits.
HWY_INLINE unsigned bitsOf(SplitMask mask) {
  std::array<std::uint8_t, 8> bits{};  // StoreMaskBits may write so many
  hn::StoreMaskBits(SplitLanes(), mask, bits.data());
  return bits[0];
}

/// Appends the points of some lanes. (Compress would copy its table with each call.)
HWY_INLINE void append(const SplitV (&points)[3], unsigned bits, Vec3d* vertices,
                       std::size_t& count) {
  alignas(64) double lanes[3][SplitVertices::kMostAtOnce];
  for (std::size_t axis = 0; axis < 3; ++axis) hn::Store(points[axis], SplitLanes(), lanes[axis]);
  for (std::size_t i = 0; i < hn::Lanes(SplitLanes()); ++i) {
    vertices[count] = {lanes[0][i], lanes[1][i], lanes[2][i]};
    count += bits >> i & 1U;
  }
}

/// A child of each lane, and its children.
struct SplitChild {
  SplitV at[3];
  SplitV children[4][3];
  SplitV size;
};

void splitVector(const SplitBatch& batch, std::size_t first, std::size_t count,
                 SplitVertices& vertices) {
  const SplitLanes d;
  using B = SplitBatch;
  const auto load = [&](const B::Lanes& lanes)
                        HWY_ATTR { return hn::Load(d, lanes.data() + first); };
  SplitChild inF, inR, inL, inVFace;
  inF.size = load(batch.sizeOfF);
  inVFace.size = load(batch.sizeOfVFace);
  inR.size = inL.size = hn::Zero(d);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto point = [&](B::Point k) HWY_ATTR { return load(batch.points[k][axis]); };
    const SplitV at = point(B::kAt);
    SplitV r[4], l[4];  // of level 2, in the quads R and L
    imagesOfQuad(at, point(B::kNext), point(B::kRightFar), point(B::kRight), r);
    imagesOfQuad(at, point(B::kPrevious), point(B::kLeftFar), point(B::kLeft), l);
    const SplitV f0 = point(B::kInF);
    const SplitV fNext = point(B::kNextInF);
    const SplitV fPrevious = point(B::kPreviousInF);
    const SplitV v0 = point(B::kInVFace);
    const SplitV vRight = point(B::kRightInVFace);
    const SplitV vLeft = point(B::kLeftInVFace);
    const SplitV none = hn::Zero(d);

    SplitV children[4];
    const auto keep = [&](SplitChild& child, SplitV centre) HWY_ATTR {
      child.at[axis] = centre;
      for (int i = 0; i < 4; ++i) child.children[i][axis] = children[i];
    };
    splitCorner({{v0, l[0], l[1]}, {r[0], f0, fPrevious}, {r[1], fNext, none}}, point(B::kDeepInF),
                children, inF.size);
    keep(inF, f0);
    splitCorner({{f0, r[0], r[3]}, {l[0], v0, vRight}, {l[3], vLeft, none}}, point(B::kDeepInVFace),
                children, inVFace.size);
    keep(inVFace, v0);
    splitRegular({{vRight, v0, l[0]}, {r[3], r[0], f0}, {r[2], r[1], fNext}}, children, inR.size);
    keep(inR, r[0]);
    splitRegular({{vLeft, l[3], l[2]}, {v0, l[0], l[1]}, {r[0], f0, fPrevious}}, children,
                 inL.size);
    keep(inL, l[0]);
  }

  const SplitV span = hn::Set(d, kVertexConversionSpan);
  const SplitV twice = hn::Set(d, 2 * kVertexConversionSpan);
  const auto used = hn::FirstN(d, count - first);
  const auto fit = [&](SplitV size) HWY_ATTR { return hn::Le(size, twice); };
  const auto done = hn::And(
      hn::And(fit(inR.size), fit(inL.size)),
      hn::And(hn::Or(hn::Le(inF.size, span), fit(hn::Mul(load(batch.contractionInF), inF.size))),
              hn::Or(hn::Le(inVFace.size, span),
                     fit(hn::Mul(load(batch.contractionInVFace), inVFace.size)))));
  vertices.deeper |= std::uint64_t{bitsOf(hn::AndNot(done, used))} << first;
  const auto given = hn::And(done, used);
  for (const SplitChild* child : {&inF, &inR, &inL, &inVFace}) {
    const auto fine = hn::Le(child->size, span);
    append(child->at, bitsOf(hn::And(given, fine)), vertices.level2.data(), vertices.count2);
    const unsigned split = bitsOf(hn::AndNot(fine, given));
    if (split == 0) continue;
    for (const auto& point : child->children)
      append(point, split, vertices.level3.data(), vertices.count3);
  }
}

void splitAll(const SplitBatch& batch, std::size_t count, SplitVertices& vertices) {
  vertices.count2 = vertices.count3 = 0;
  vertices.deeper = 0;
  for (std::size_t first = 0; first < count; first += hn::Lanes(SplitLanes()))
    splitVector(batch, first, count, vertices);
}

}  // namespace
}  // namespace vox::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vox {

HWY_EXPORT(splitAll);

void splitAll(const SplitBatch& batch, std::size_t count, SplitVertices& vertices) {
  HWY_DYNAMIC_DISPATCH(splitAll)(batch, count, vertices);
}

}  // namespace vox
#endif
