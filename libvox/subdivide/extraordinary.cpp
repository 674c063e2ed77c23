// Subdivision around isolated faces that are not quads, a ring at a time.

#include "libvox/subdivide/extraordinary.h"

#include "libvox/core/error.h"
#include "libvox/subdivide/stop.h"
#include "libvox/subdivide/vertex_split.h"

#include <algorithm>
#include <utility>

namespace vox {
namespace {

/// Sizes halve with every level, from 2^32 voxels at most.
constexpr int kMostLevels = 64;

void requireDepth(int level) {
  if (level > kMostLevels)
    throw LimitError("the surface needs more than " + std::to_string(kMostLevels) +
                     " subdivision levels; use larger voxels");
}

Vec3d middle(const Vec3d& a, const Vec3d& b) {
  return (a + b) / 2.0;
}

double quadDiameter(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
  const std::array<Vec3d, 4> corners = {a, b, c, d};
  return diameter(corners);
}

std::size_t before(const ExtraordinaryFace& face, std::size_t i) {
  return (i == 0 ? face.inner.size() : i) - 1;
}
std::size_t after(const ExtraordinaryFace& face, std::size_t i) {
  return i + 1 == face.inner.size() ? 0 : i + 1;
}

/// Where the polygon is mirrored, its real half ends at the middle of two edges.
bool mirrored(const ExtraordinaryFace& face) {
  return face.real < face.inner.size();
}

double faceDiameter(const ExtraordinaryFace& face, std::vector<Vec3d>& work) {
  if (!mirrored(face)) return diameter(face.inner);
  work.assign(face.inner.begin(), face.inner.begin() + static_cast<std::ptrdiff_t>(face.real));
  work.push_back(middle(face.inner[face.real - 1], face.inner[face.real]));
  work.push_back(middle(face.inner.back(), face.inner.front()));
  return diameter(work);
}

/// Diameter of the face across the edge i, i+1; of a mirrored one, of its real half.
double edgeDiameter(const ExtraordinaryFace& face, std::size_t i) {
  const Vec3d& a = face.inner[i];
  const Vec3d& b = face.inner[after(face, i)];
  if (mirrored(face) && i == face.real - 1)
    return quadDiameter(a, middle(a, b), middle(face.near[i], face.far[i]), face.near[i]);
  if (mirrored(face) && i + 1 == face.inner.size())
    return quadDiameter(b, middle(a, b), middle(face.near[i], face.far[i]), face.far[i]);
  return quadDiameter(a, b, face.far[i], face.near[i]);
}

bool fineAround(const ExtraordinaryFace& face, std::size_t i) {
  const std::size_t j = before(face, i);
  return (!face.hasEdge[i] || edgeDiameter(face, i) <= kVertexConversionSpan) &&
         (!face.hasEdge[j] || edgeDiameter(face, j) <= kVertexConversionSpan) &&
         (!face.hasCorner[i] || quadDiameter(face.inner[i], face.near[i], face.corner[i],
                                             face.far[j]) <= kVertexConversionSpan);
}

VertexSplit splitAt(const ExtraordinaryFace& face, const std::vector<Vec3d>& images,
                    std::size_t i) {
  const std::size_t j = before(face, i);
  const std::size_t n = after(face, i);
  const Vec3d& at = face.inner[i];
  VertexSplit split;
  split.f0 = images[i];
  split.fNext = images[n];
  split.fPrevious = images[j];
  split.r = quadImages(at, face.inner[n], face.far[i], face.near[i]);
  split.l = quadImages(at, face.inner[j], face.near[j], face.far[j]);
  split.setK(quadImages(at, face.near[i], face.corner[i], face.far[j]));
  split.hasR = face.hasEdge[i];
  split.hasL = face.hasEdge[j];
  split.hasK = face.hasCorner[i];
  return split;
}

/// The surroundings of corner i one level down.
void descend(const VertexSplit& split, std::size_t i, ExtraordinaryFace& next) {
  const std::size_t j = before(next, i);
  next.near[i] = split.r[0];
  next.far[i] = split.r[1];
  next.near[j] = split.l[1];
  next.far[j] = split.l[0];
  next.corner[i] = split.k0;
  next.active[i] = true;
}

}  // namespace

void ExtraordinaryFace::reset(std::size_t n) {
  for (auto* points : {&inner, &near, &far, &corner}) points->assign(n, Vec3d::Zero());
  active.assign(n, false);
  hasEdge.assign(n, true);
  hasCorner.assign(n, true);
  real = n;
}

void ExtraordinarySubdivision::run(ExtraordinaryFace& face, int level, SurfaceSink& sink) {
  const std::size_t n = face.inner.size();
  next_ = face;
  for (;; ++level) {
    requireDepth(level);
    if (faceDiameter(face, innerImages_) <= kVertexConversionSpan) {
      finished_.clear();
      for (std::size_t i = 0; i < n; ++i) {
        if (!face.active[i] || !fineAround(face, i)) continue;
        finished_.push_back(face.inner[i]);
        face.active[i] = false;
      }
      if (!finished_.empty()) sink.points(finished_, level);
    }
    if (std::find(face.active.begin(), face.active.end(), true) == face.active.end()) return;

    innerImages_.resize(n);
    images_.of(face.inner, innerImages_);
    std::fill(next_.active.begin(), next_.active.end(), false);
    for (std::size_t i = 0; i < n; ++i) {
      if (!face.active[i]) continue;
      const VertexSplit split = splitAt(face, innerImages_, i);
      split.emitSides(level + 1, sink);
      split.emitInK(level + 1, sink);
      descend(split, i, next_);
    }
    next_.inner = innerImages_;
    std::swap(face, next_);
  }
}

TriangleImages::TriangleImages(const Vec3d& at, const Vec3d& start, const Vec3d& end)
    : u((2.0 * at + start + end) / 4.0),
      mStart((3.0 * start + end) / 4.0),
      mEnd((start + 3.0 * end) / 4.0) {}

void subdivideBoundaryCorner(BoundaryCorner at, int level, SurfaceSink& sink) {
  for (;; ++level) {
    requireDepth(level);
    const std::array<Vec3d, 3> triangle = {at.u, at.mStart, at.mEnd};
    const double size =
        std::max({diameter(triangle), quadDiameter(at.u, at.right, at.mRight, at.mStart),
                  quadDiameter(at.u, at.left, at.mLeft, at.mEnd),
                  quadDiameter(at.u, at.right, at.opposite, at.left)});
    if (size <= kVertexConversionSpan) return sink.points({&at.u, 1}, level);

    const auto mirror = [](const Vec3d& p, const Vec3d& m) -> Vec3d { return 2.0 * m - p; };
    const TriangleImages t(at.u, at.mStart, at.mEnd);
    VertexSplit split;
    split.setF(quadImages(at.u, at.right, at.opposite, at.left));
    split.r = quadImages(at.u, at.right, mirror(at.right, at.mRight), mirror(at.u, at.mStart));
    split.l = quadImages(at.u, at.left, mirror(at.left, at.mLeft), mirror(at.u, at.mEnd));
    split.k0 = t.u;
    split.kRight = mirror(t.u, t.mStart);
    split.kLeft = mirror(t.u, t.mEnd);
    split.emitSides(level + 1, sink);
    split.emitInF(level + 1, sink);

    const Vec3d mRight =
        (3.0 * at.mStart + at.mRight) / 4.0;  // the children of the strips' corners
    const Vec3d mLeft = (3.0 * at.mEnd + at.mLeft) / 4.0;
    at = {t.u, t.mStart, t.mEnd, split.r[0], mRight, split.l[0], mLeft, split.f0};
  }
}

}  // namespace vox
