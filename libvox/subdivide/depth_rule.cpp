// How deep vertices are subdivided for each stop rule.

#include "libvox/subdivide/depth_rule.h"

#include "libvox/core/error.h"
#include "libvox/subdivide/face_shape.h"
#include "libvox/subdivide/stop.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace vox {
namespace {

double halved(double length, int times) {
  return std::ldexp(length, -times);
}

/// Normal of the four neighbours of a vertex; 0 if it has none.
Vec3d normalOf(const Vec3d& alongU, const Vec3d& alongV) {
  const Vec3d normal = alongU.cross(alongV).stableNormalized();
  return normal.squaredNorm() > 0.5 ? normal : Vec3d::Zero();
}

/// Least k <= most for which fine(k) holds, else most.
template <class Fine>
int leastDepth(int most, Fine&& fine) {
  int k = 0;
  while (k < most && !fine(k)) ++k;
  return k;
}

VertexDepth squareOf(int k) {
  return {static_cast<std::uint8_t>(k), static_cast<std::uint8_t>(k)};
}

/// From the least depth that is the same along u and v, lessens one axis and then the other, both
/// ways round.
template <class Fine>
VertexDepth leastDepths(int most, Fine&& fine) {
  const int k = leastDepth(most, [&](int depth) { return fine(depth, depth); });
  int u = k;
  int v = k;
  while (u > 0 && fine(u - 1, v)) --u;
  while (v > 0 && fine(u, v - 1)) --v;
  int otherU = k;
  int otherV = k;
  while (otherV > 0 && fine(otherU, otherV - 1)) --otherV;
  while (otherU > 0 && fine(otherU - 1, otherV)) --otherU;
  const bool other = otherU + otherV < u + v;
  return {static_cast<std::uint8_t>(other ? otherU : u),
          static_cast<std::uint8_t>(other ? otherV : v)};
}

/// Criteria that a summary of a patch decides for all depths: fine(summary, u, v).
template <class Self, class Summary>
class SummaryCriterion : public Criterion {
 public:
  int squareDepth(const Patch& patch, int most) const override {
    const Summary summary(patch);
    return leastDepth(most, [&](int k) { return self().fineBelow(summary, k, k); });
  }
  VertexDepth regularDepth(const Patch& patch, int most) const override {
    const Summary summary(patch);
    return leastDepths(most, [&](int u, int v) { return self().fineBelow(summary, u, v); });
  }

 private:
  const Self& self() const { return static_cast<const Self&>(*this); }
};

class DiameterCriterion : public SummaryCriterion<DiameterCriterion, PatchSteps> {
 public:
  explicit DiameterCriterion(double limit) : limit_(limit) {}

  bool fineBelow(const PatchSteps& steps, int u, int v) const {
    return steps.sizeBelow(u, v) <= limit_;
  }
  bool fine(const VertexFaces& faces) const override {
    double size = faces.f.diameter;
    if (faces.hasK) size = std::max(size, faces.k.diameter);
    if (faces.hasR) size = std::max(size, diameter(faces.r));
    if (faces.hasL) size = std::max(size, diameter(faces.l));
    return size <= limit_;
  }

 private:
  double limit_;
};

/// A patch with what is missing of it made straight.
Patch completed(Patch patch) {
  if (patch.quadrants == kAllQuadrants) return patch;
  auto& p = patch.points;
  const auto has = [&](unsigned quadrants) { return (patch.quadrants & quadrants) != 0; };
  if (!has(1U | 2U)) p[0][1] = 2.0 * p[1][1] - p[2][1];
  if (!has(1U | 4U)) p[1][0] = 2.0 * p[1][1] - p[1][2];
  if (!has(4U | 8U)) p[2][1] = 2.0 * p[1][1] - p[0][1];
  if (!has(2U | 8U)) p[1][2] = 2.0 * p[1][1] - p[1][0];
  for (unsigned q = 0; q < 4; ++q) {
    const std::size_t u = q & 2U;
    const std::size_t v = 2 * (q & 1U);
    if (!has(1U << q)) p[u][v] = p[u][1] + p[1][v] - p[1][1];
  }
  return patch;
}

/// Second differences of a patch, at their largest: along its normal, with what may turn into it.
struct PatchBends {
  double uu = 0, vv = 0, uv = 0;
  double sine = 0;  ///< of the largest angle between the mean normal and another

  /// @param patch  complete
  explicit PatchBends(const Patch& patch) {
    const auto& p = patch.points;
    const Vec3d normal = normalOf(p[2][1] - p[0][1], p[1][2] - p[1][0]);
    sine = largestSine(patch, normal);
    const auto take = [&](double& largest, const Vec3d& bend) {
      const double size = bend.norm();
      largest = std::max(largest, std::min(size, std::abs(normal.dot(bend)) + sine * size));
    };
    for (std::size_t i = 0; i < 3; ++i) {
      take(uu, p[0][i] - 2.0 * p[1][i] + p[2][i]);
      take(vv, p[i][0] - 2.0 * p[i][1] + p[i][2]);
    }
    for (std::size_t u = 0; u < 2; ++u)
      for (std::size_t v = 0; v < 2; ++v)
        take(uv, p[u][v] - p[u + 1][v] - p[u][v + 1] + p[u + 1][v + 1]);
  }

 private:
  /// Of the angles between a normal and those of the four faces at their corners; 1 if one turns
  /// over.
  static double largestSine(const Patch& patch, const Vec3d& normal) {
    const auto& p = patch.points;
    double largest = 0;
    for (std::size_t u = 0; u < 3; ++u)
      for (std::size_t v = 0; v < 3; ++v) {
        const std::size_t a = u == 0 ? 1 : u;
        const std::size_t b = v == 0 ? 1 : v;
        const Vec3d here = normalOf(p[a][v] - p[a - 1][v], p[u][b] - p[u][b - 1]);
        if (!(here.dot(normal) > 0)) return 1;
        largest = std::max(largest, here.cross(normal).norm());
      }
    return largest;
  }
};

/// One level below a complete patch.
std::array<Patch, 4> childrenOf(const Patch& patch) {
  std::array<CurvePoints, 4> rows;
  for (int i = -1; i <= 2; ++i) rows[static_cast<std::size_t>(i + 1)] = rowOf(patch, {i, 2});
  std::array<Patch, 4> children;
  for (std::size_t child = 0; child < 4; ++child)
    for (std::size_t u = 0; u < 3; ++u)
      for (std::size_t v = 0; v < 3; ++v) {
        const CurvePoints& row = rows[child / 2 + u];
        const auto j = static_cast<std::int64_t>(child % 2 + v) - 1;
        children[child].points[u][v] = PatchWeights(j, 2)(row[0], row[1], row[2]);
      }
  return children;
}

class FlatnessCriterion : public Criterion {
 public:
  explicit FlatnessCriterion(double limit) : limit_(limit) {}

  int squareDepth(const Patch& patch, int most) const override {
    constexpr int kMostSplits = 4;
    return squareDepth(completed(patch), most, kMostSplits);
  }
  VertexDepth regularDepth(const Patch& partial, int most) const override {
    const Patch patch = completed(partial);
    const PatchBends bends(patch);
    const VertexDepth apart =
        leastDepths(most, [&](int u, int v) { return fineBelow(bends, u, v); });
    const int square = squareDepth(patch, most);
    return 2 * square < apart.u + apart.v ? squareOf(square) : apart;
  }
  bool fine(const VertexFaces& faces) const override {
    const Vec3d normal = normalOf(faces.next - faces.left, faces.previous - faces.right);
    double height = faces.f.height;
    if (faces.hasK) height = std::max(height, faces.k.height);
    const auto take = [&](const Vec3d& point) {
      const Vec3d step = point - faces.at;
      height = std::max(height, (normal.isZero() ? step.norm() : std::abs(normal.dot(step))) / 2);
    };
    for (std::size_t i = 1; i < 4; ++i) {
      if (faces.hasR) take(faces.r[i]);
      if (faces.hasL) take(faces.l[i]);
    }
    return height <= limit_;
  }
  int curveDepth(const CurvePoints& points, int most) const override {
    const double bend = (points[0] - 2.0 * points[1] + points[2]).norm();
    return leastDepth(most, [&](int k) { return halved(bend, 2 * k) / 8 <= limit_; });
  }

 private:
  bool fineBelow(const PatchBends& bends, int u, int v) const {
    return (halved(bends.uu, 2 * u) + halved(bends.vv, 2 * v)) / 8 + halved(bends.uv, u + v) / 4 <=
           limit_;
  }

  /// Where the patch turns much, its parts have better normals to measure along.
  int squareDepth(const Patch& patch, int most, int splits) const {
    constexpr double kTurnsMuch = 0.1;
    const PatchBends bends(patch);
    const int k = leastDepth(most, [&](int depth) { return fineBelow(bends, depth, depth); });
    if (k < 2 || splits == 0 || bends.sine < kTurnsMuch) return k;
    int below = 0;
    for (const Patch& child : childrenOf(patch))
      below = std::max(below, squareDepth(child, k - 1, splits - 1));
    return 1 + below;
  }

  double limit_;
};

class AngleCriterion : public Criterion {
 public:
  explicit AngleCriterion(double limit) : limit_(limit) {}

  int squareDepth(const Patch& partial, int most) const override {
    const Patch patch = completed(partial);
    const PatchSteps steps(partial);
    constexpr int kMostMeasured = 10;  // where so many vertices turn, it is a fold
    return leastDepth(most, [&](int k) {
      return steps.sizeBelow(k, k) <= 1 ||
             (k <= kMostMeasured && largestAngle(patch, std::int64_t{1} << k) <= limit_);
    });
  }
  VertexDepth regularDepth(const Patch& patch, int most) const override {
    return squareOf(squareDepth(patch, most));
  }
  bool fine(const VertexFaces& faces) const override {
    if (DiameterCriterion(1).fine(faces)) return true;
    const Vec3d r = shapeOf(faces.r).normal;
    const Vec3d l = -shapeOf(faces.l).normal;  // runs round the other way
    double largest = 0;
    const auto take = [&](bool exist, const Vec3d& a, const Vec3d& b) {
      if (exist) largest = std::max(largest, angleBetween(a, b));
    };
    take(faces.hasR, faces.f.normal, r);
    take(faces.hasL, faces.f.normal, l);
    take(faces.hasR && faces.hasK, faces.k.normal, r);
    take(faces.hasL && faces.hasK, faces.k.normal, l);
    return largest <= limit_;
  }

 private:
  /// Of the faces that touch one of n x n descendants, or more than the limit. The closed form goes
  /// on for one row beyond them.
  double largestAngle(const Patch& patch, std::int64_t n) const {
    std::vector<Vec3d> before, here, normalsBefore, normals;
    double largest = 0;
    for (std::int64_t i = -1; i <= n; ++i) {
      const CurvePoints row = rowOf(patch, PatchWeights(i, n));
      here.clear();
      for (std::int64_t j = -1; j <= n; ++j)
        here.push_back(PatchWeights(j, n)(row[0], row[1], row[2]));
      normals.clear();
      for (std::size_t j = 1; j < before.size(); ++j)
        normals.push_back(normalOf(here[j] - before[j - 1], before[j] - here[j - 1]));
      for (std::size_t j = 1; j < normals.size(); ++j)
        largest = std::max(largest, angleBetween(normals[j - 1], normals[j]));
      for (std::size_t j = 0; j < normalsBefore.size(); ++j)
        largest = std::max(largest, angleBetween(normalsBefore[j], normals[j]));
      if (largest > limit_) return largest;
      std::swap(normals, normalsBefore);
      std::swap(here, before);
    }
    return largest;
  }

  double limit_;
};

/// The faces around corner i of a ring.
VertexFaces facesOf(const ExtraordinaryRings::Ring& ring, std::size_t i) {
  const ExtraordinaryFace& face = ring.face;
  const std::size_t j = face.before(i);
  const std::size_t n = face.after(i);
  VertexFaces faces{face.inner[i],
                    face.inner[n],
                    face.inner[j],
                    face.near[i],
                    face.far[j],
                    ring.shape,
                    {},
                    {},
                    {}};
  faces.r = {faces.at, faces.next, face.far[i], face.near[i]};
  faces.l = {faces.at, faces.previous, face.near[j], face.far[j]};
  faces.k = shapeOf(std::array<Vec3d, 4>{faces.at, faces.left, face.corner[i], faces.right});
  faces.hasR = face.hasEdge[i];
  faces.hasL = face.hasEdge[j];
  faces.hasK = face.hasCorner[i];
  return faces;
}

VertexFaces facesOf(const BoundaryCorner& corner) {
  VertexFaces faces{corner.u,
                    corner.right,
                    corner.left,
                    2.0 * corner.mStart - corner.u,
                    2.0 * corner.mEnd - corner.u,
                    {},
                    {},
                    {},
                    {}};
  faces.r = {faces.at, faces.next, corner.mRight, corner.mStart};
  faces.l = {faces.at, faces.previous, corner.mLeft, corner.mEnd};
  faces.f = shapeOf(std::array<Vec3d, 4>{corner.u, corner.right, corner.opposite, corner.left});
  faces.k = shapeOf(std::array<Vec3d, 3>{corner.u, corner.mEnd, corner.mStart});
  return faces;
}

/// Levels below an irregular vertex for one criterion. What is found on the way down only rises.
class IrregularDepth {
 public:
  IrregularDepth(const Criterion& criterion, int most) : criterion_(criterion), most_(most) {}

  int of(const LevelOneVertex& vertex, const VertexFaces& faces) {
    if (most_ == 0 || criterion_.fine(faces)) return 0;
    depth_ = 1;
    const VertexSplit& split = vertex.split;
    if (split.hasR) take(split.childInR(), 1);
    if (split.hasL) take(split.childInL(), 1);
    if (vertex.quadF)
      take(split.childInF(), 1);
    else
      takeRings(*vertex.ringsOfF, vertex.placeInF);
    if (!split.hasK) return depth_;
    if (vertex.corner)
      takeCorner(*vertex.corner);
    else if (vertex.quadK)
      take(split.childInK(), 1);
    else
      takeRings(*vertex.ringsOfK, vertex.placeInK);
    return depth_;
  }

 private:
  /// A regular vertex, some levels down.
  void take(const Patch& patch, int below) {
    if (below < most_)
      depth_ = std::max(depth_, below + criterion_.squareDepth(patch, most_ - below));
    else
      depth_ = most_;
  }

  void takeRings(ExtraordinaryRings& rings, std::size_t place) {
    for (int l = 0; depth_ < most_; ++l) {
      if (depth_ <= l + 1 && criterion_.fine(facesOf(rings.ring(l), place))) {
        depth_ = l + 1;
        return;
      }
      const VertexSplit split = rings.split(l, place);
      if (split.hasR) take(split.childInR(), l + 2);
      if (split.hasL) take(split.childInL(), l + 2);
      if (split.hasK) take(split.childInK(), l + 2);
    }
  }

  void takeCorner(BoundaryCorner corner) {
    for (int l = 0; depth_ < most_; ++l) {
      if (depth_ <= l + 1 && criterion_.fine(facesOf(corner))) {
        depth_ = l + 1;
        return;
      }
      const VertexSplit split = corner.split();
      for (const Patch& child : {split.childInR(), split.childInL(), split.childInF()})
        take(child, l + 2);
      corner = corner.below(split);
    }
  }

  const Criterion& criterion_;
  int most_;
  int depth_ = 0;
};

VertexDepth depthFor(const Criterion& criterion, const LevelOneVertex& vertex,
                     const VertexFaces* faces, const BoundaryCurves& curves, int most) {
  VertexDepth depth = vertex.regular ? criterion.regularDepth(vertex.patch, most)
                                     : squareOf(IrregularDepth(criterion, most).of(vertex, *faces));
  const auto deepen = [&](std::uint8_t& along, const std::optional<CurvePoints>& curve) {
    if (curve)
      along = std::max(along, static_cast<std::uint8_t>(criterion.curveDepth(*curve, most)));
  };
  deepen(depth.u, curves.acrossR);
  deepen(depth.v, curves.acrossL);
  return vertex.regular ? depth : squareOf(std::max(depth.u, depth.v));
}

}  // namespace

DepthRule::DepthRule(const StopRule& rule)
    : most_(rule.levels ? std::max(*rule.levels - 1, 0) : kMostDepth) {
  if (rule.diameter) criteria_.push_back(std::make_unique<DiameterCriterion>(*rule.diameter));
  if (rule.flatness) criteria_.push_back(std::make_unique<FlatnessCriterion>(*rule.flatness));
  if (rule.angle) criteria_.push_back(std::make_unique<AngleCriterion>(*rule.angle));
}

VertexDepth DepthRule::of(const LevelOneVertex& vertex, const VertexFaces* faces,
                          const BoundaryCurves& curves) const {
  VertexDepth least = squareOf(most_);
  for (const auto& criterion : criteria_) {
    const VertexDepth depth = depthFor(*criterion, vertex, faces, curves, most_);
    if (depth.u + depth.v < least.u + least.v) least = depth;
  }
  return least;
}

VertexDepth DepthRule::within(const Patch& patch, VertexDepth own) const {
  VertexDepth least = own;
  for (const auto& criterion : criteria_) {
    const VertexDepth depth = criterion->regularDepth(patch, std::max(own.u, own.v));
    if (depth.u + depth.v < least.u + least.v) least = depth;
  }
  return least;
}

}  // namespace vox
