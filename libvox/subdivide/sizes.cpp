// Differences and boxes of a dozen points, all three coordinates at once.

// Highway compiles this file once per instruction set, between HWY_BEFORE_ and HWY_AFTER_NAMESPACE.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "libvox/subdivide/sizes.cpp"
#include "libvox/subdivide/sizes.h"

#include "libvox/subdivide/vertex_split.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <array>

HWY_BEFORE_NAMESPACE();
namespace vox::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<double, 4>;
constexpr std::size_t kLanes = hn::MaxLanes(D());
constexpr std::size_t kParts = 4 / kLanes;

// Coords reads 8 bytes behind each point of a Patch or a VertexSplit. Both hold their points first,
// and these bytes at least behind the last one.
constexpr std::size_t kSplitPoints = 16;
static_assert(sizeof(Patch) >= sizeof(Patch::points) + sizeof(double));
static_assert(sizeof(VertexSplit) >= kSplitPoints * sizeof(Vec3d) + sizeof(double));

/// Three coordinates and a zero, in one vector or in several.
struct Coords {
  hn::Vec<D> parts[kParts];

  Coords() {
    for (auto& part : parts) part = hn::Zero(D());
  }
  /// @param p  a point of a Patch or a VertexSplit: up to 8 bytes behind it are read
  explicit Coords(const Vec3d& p) {
    for (std::size_t i = 0; i < kParts; ++i) {
      const std::size_t first = std::min<std::size_t>(i * kLanes, 3);
      parts[i] = first == 3 ? hn::Zero(D())
                            : hn::IfThenElseZero(hn::FirstN(D(), 3 - first),
                                                 hn::LoadU(D(), p.data() + first));
    }
  }
};

template <class Operation>
Coords each(const Coords& a, const Coords& b, Operation&& operation) {
  Coords result;
  for (std::size_t i = 0; i < kParts; ++i) result.parts[i] = operation(a.parts[i], b.parts[i]);
  return result;
}

using V = hn::Vec<D>;
inline Coords operator+(const Coords& a, const Coords& b) {
  return each(a, b, [](V x, V y) HWY_ATTR { return hn::Add(x, y); });
}
inline Coords operator-(const Coords& a, const Coords& b) {
  return each(a, b, [](V x, V y) HWY_ATTR { return hn::Sub(x, y); });
}
inline Coords min(const Coords& a, const Coords& b) {
  return each(a, b, [](V x, V y) HWY_ATTR { return hn::Min(x, y); });
}
inline Coords max(const Coords& a, const Coords& b) {
  return each(a, b, [](V x, V y) HWY_ATTR { return hn::Max(x, y); });
}
inline Coords step(const Coords& a, const Coords& b) {
  return each(a, b, [](V x, V y) HWY_ATTR { return hn::Abs(hn::Sub(x, y)); });
}
inline Vec3d pointOf(const Coords& a) {
  alignas(32) std::array<double, 4> values;
  for (std::size_t i = 0; i < kParts; ++i) hn::Store(a.parts[i], D(), values.data() + i * kLanes);
  return {values[0], values[1], values[2]};
}

inline double largest(const Coords& a) {
  return pointOf(a).maxCoeff();
}

inline Coords box(const Coords& a, const Coords& b, const Coords& c, const Coords& d) {
  return max(max(a, b), max(c, d)) - min(min(a, b), min(c, d));
}

inline Coords largestOf(const Coords& a, const Coords& b, const Coords& c, const Coords& d) {
  return max(max(a, b), max(c, d));
}

/// Largest steps between neighbouring control points along u and along v. A step counts if a
/// quadrant beside it exists.
void steps(const Patch& patch, Vec3d& u, Vec3d& v) {
  constexpr unsigned kBesideU[2][3] = {{1, 3, 2}, {4, 12, 8}};
  constexpr unsigned kBesideV[2][3] = {{1, 5, 4}, {2, 10, 8}};
  Coords p[3][3];
  for (std::size_t a = 0; a < 3; ++a)
    for (std::size_t b = 0; b < 3; ++b) p[a][b] = Coords(patch.points[a][b]);
  Coords alongU;
  Coords alongV;
  for (std::size_t a = 0; a < 2; ++a)
    for (std::size_t b = 0; b < 3; ++b) {
      if ((patch.quadrants & kBesideU[a][b]) != 0) alongU = max(alongU, step(p[a + 1][b], p[a][b]));
      if ((patch.quadrants & kBesideV[a][b]) != 0) alongV = max(alongV, step(p[b][a + 1], p[b][a]));
    }
  u = pointOf(alongU);
  v = pointOf(alongV);
}

ChildSizes sizes(const VertexSplit& split) {
  const Coords f0(split.f0), fNext(split.fNext), fPrevious(split.fPrevious);
  const Coords r0(split.r[0]), r1(split.r[1]), r2(split.r[2]), r3(split.r[3]);
  const Coords l0(split.l[0]), l1(split.l[1]), l2(split.l[2]), l3(split.l[3]);
  const Coords vFace0(split.vFace0), vFaceRight(split.vFaceRight), vFaceLeft(split.vFaceLeft);

  // Steps around the vertex, which the patches of both children contain.
  const Coords u = max(step(r0, vFace0), step(f0, l0));
  const Coords v = max(step(l0, vFace0), step(f0, r0));
  const Coords uR =
      max(u, largestOf(step(r3, vFaceRight), step(r2, r3), step(r1, r0), step(fNext, f0)));
  const Coords vR =
      max(v, largestOf(step(vFace0, vFaceRight), step(r0, r3), step(r1, r2), step(fNext, r1)));
  const Coords uL =
      max(u, largestOf(step(vFace0, vFaceLeft), step(l0, l3), step(l1, l2), step(fPrevious, l1)));
  const Coords vL =
      max(v, largestOf(step(l3, vFaceLeft), step(l2, l3), step(l1, l0), step(fPrevious, f0)));

  const Coords middle = box(f0, r0, vFace0, l0);
  const Coords aroundF = max(middle, max(box(f0, fNext, r1, r0), box(f0, fPrevious, l1, l0)));
  const Coords aroundVFace =
      max(middle, max(box(vFace0, vFaceRight, r3, r0), box(vFace0, vFaceLeft, l3, l0)));
  return {largest(aroundF), largest(aroundVFace), largest(uR + vR), largest(uL + vL)};
}

}  // namespace vox::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vox {
namespace {

HWY_EXPORT(steps);
HWY_EXPORT(sizes);

}  // namespace

PatchSteps::PatchSteps(const Patch& patch) {
  HWY_DYNAMIC_DISPATCH(steps)(patch, u, v);
}

ChildSizes childSizes(const VertexSplit& split) {
  return HWY_DYNAMIC_DISPATCH(sizes)(split);
}

}  // namespace vox
#endif
