// Subdivision around isolated faces that are not quads, level by level.

#include "libvox/subdivide/extraordinary.h"

#include "libvox/core/error.h"
#include "libvox/mesh/chaikin.h"
#include "libvox/subdivide/stop.h"

#include <algorithm>
#include <utility>

namespace vox {
namespace {

double faceDiameter(const ExtraordinaryFace& face, std::vector<Vec3d>& work) {
  if (!face.mirrored()) return diameter(face.inner);
  work.assign(face.inner.begin(), face.inner.begin() + static_cast<std::ptrdiff_t>(face.real));
  work.push_back(middle(face.inner[face.real - 1], face.inner[face.real]));
  work.push_back(middle(face.inner.back(), face.inner.front()));
  return diameter(work);
}

/// Diameter of the face across the edge i, i+1; of its real half if it is mirrored.
double edgeDiameter(const ExtraordinaryFace& face, std::size_t i) {
  const Vec3d& a = face.inner[i];
  const Vec3d& b = face.inner[face.after(i)];
  if (face.mirrored() && i == face.real - 1)
    return diameter(a, middle(a, b), middle(face.near[i], face.far[i]), face.near[i]);
  if (face.mirrored() && i + 1 == face.inner.size())
    return diameter(b, middle(a, b), middle(face.near[i], face.far[i]), face.far[i]);
  return diameter(a, b, face.far[i], face.near[i]);
}

/// Largest diameter of the faces at corner i, without the polygon itself.
double diameterAround(const ExtraordinaryFace& face, std::size_t i) {
  const std::size_t j = face.before(i);
  double size = 0;
  if (face.hasEdge[i]) size = edgeDiameter(face, i);
  if (face.hasEdge[j]) size = std::max(size, edgeDiameter(face, j));
  if (face.hasCorner[i])
    size = std::max(size, diameter(face.inner[i], face.near[i], face.corner[i], face.far[j]));
  return size;
}

}  // namespace

void ExtraordinaryFace::reset(std::size_t n) {
  for (auto* points : {&inner, &near, &far, &corner}) points->assign(n, Vec3d::Zero());
  active.assign(n, false);
  hasEdge.assign(n, true);
  hasCorner.assign(n, true);
  real = n;
}

void ExtraordinaryFace::join(std::size_t i, const VertexSplit& split) {
  const std::size_t j = before(i);
  near[i] = split.r[0];
  far[i] = split.r[1];
  near[j] = split.l[1];
  far[j] = split.l[0];
  corner[i] = split.vFace0;
  active[i] = true;
}

VertexSplit ExtraordinaryFace::splitAt(std::span<const Vec3d> images, std::size_t i) const {
  const std::size_t j = before(i);
  const std::size_t n = after(i);
  const Vec3d& at = inner[i];
  VertexSplit split;
  split.f0 = images[i];
  split.fNext = images[n];
  split.fPrevious = images[j];
  split.r = quadImages(at, inner[n], far[i], near[i]);
  split.l = quadImages(at, inner[j], near[j], far[j]);
  split.setVFace(quadImages(at, near[i], corner[i], far[j]));
  split.hasR = hasEdge[i];
  split.hasL = hasEdge[j];
  split.hasVFace = hasCorner[i];
  return split;
}

void requireLevelInRange(int level) {
  constexpr int kDeepestLevel = 64;
  if (level > kDeepestLevel)
    throw LimitError("the surface needs more than " + std::to_string(kDeepestLevel) +
                     " subdivision levels; use larger voxels");
}

void ExtraordinarySubdivision::run(ExtraordinaryFace& face, int level, SurfaceSink& sink) {
  const std::size_t n = face.inner.size();
  const double contractionHere = std::max(contraction(n), contraction(4));
  next_ = face;
  for (;; ++level) {
    requireLevelInRange(level);
    innerImages_.resize(n);
    images_.of(face.inner, innerImages_);
    const double size = faceDiameter(face, work_);
    finished_.clear();
    finishedChildren_.clear();
    std::fill(next_.active.begin(), next_.active.end(), false);
    bool done = true;
    for (std::size_t i = 0; i < n; ++i) {
      if (!face.active[i]) continue;
      const double largest = std::max(size, diameterAround(face, i));
      if (largest <= kVertexConversionSpan) {
        finished_.push_back(face.inner[i]);
        continue;
      }
      const VertexSplit split = face.splitAt(innerImages_, i);
      if (!face.mirrored() && split.hasR && split.hasL && split.hasVFace &&
          childrenFineEnough(largest, contractionHere)) {
        for (const Vec3d& child : {split.f0, split.r[0], split.l[0], split.vFace0})
          finishedChildren_.push_back(child);
        continue;
      }
      split.emitSides(level + 1, sink);
      split.emitInVFace(level + 1, sink);
      next_.join(i, split);
      done = false;
    }
    if (!finished_.empty()) sink.points(finished_, level);
    if (!finishedChildren_.empty()) sink.points(finishedChildren_, level + 1);
    if (done) return;
    next_.inner = innerImages_;
    std::swap(face, next_);
  }
}

TriangleImages::TriangleImages(const Vec3d& at, const Vec3d& start, const Vec3d& end)
    : u((2.0 * at + start + end) / 4.0), mStart(chaikin(start, end)), mEnd(chaikin(end, start)) {}

void TriangleImages::setVFace(VertexSplit& split) const {
  split.vFace0 = u;
  split.vFaceRight = mirrored(u, mStart);
  split.vFaceLeft = mirrored(u, mEnd);
}

BoundaryCorner TriangleImages::below(const VertexSplit& split) const {
  return {u,
          mStart,
          mEnd,
          split.r[0],
          middle(split.r[0], split.r[3]),
          split.l[0],
          middle(split.l[0], split.l[3]),
          split.f0};
}

VertexSplit BoundaryCorner::split() const {
  VertexSplit split;
  split.setF(quadImages(u, right, opposite, left));
  split.r = quadImages(u, right, mirrored(right, mRight), mirrored(u, mStart));
  split.l = quadImages(u, left, mirrored(left, mLeft), mirrored(u, mEnd));
  TriangleImages(u, mStart, mEnd).setVFace(split);
  return split;
}

BoundaryCorner BoundaryCorner::below(const VertexSplit& split) const {
  const TriangleImages t(u, mStart, mEnd);
  // mRight and mLeft: the children of the corners of the strips.
  return {t.u,
          t.mStart,
          t.mEnd,
          split.r[0],
          chaikin(mStart, mRight),
          split.l[0],
          chaikin(mEnd, mLeft),
          split.f0};
}

void subdivideBoundaryCorner(BoundaryCorner at, int level, SurfaceSink& sink) {
  for (;; ++level) {
    requireLevelInRange(level);
    const std::array<Vec3d, 3> triangle = {at.u, at.mStart, at.mEnd};
    const double size =
        std::max({diameter(triangle), diameter(at.u, at.right, at.mRight, at.mStart),
                  diameter(at.u, at.left, at.mLeft, at.mEnd),
                  diameter(at.u, at.right, at.opposite, at.left)});
    if (size <= kVertexConversionSpan) return sink.points({&at.u, 1}, level);
    const VertexSplit split = at.split();
    split.emitSides(level + 1, sink);
    split.emitInF(level + 1, sink);
    at = at.below(split);
  }
}

}  // namespace vox
