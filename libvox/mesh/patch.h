#pragma once

#include "libvox/core/types.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

namespace vox {

/// The four faces around a vertex, by where they lie: u-, v- is quadrant 0, u-, v+ is 1, u+, v- is
/// 2, u+, v+ is 3; bit q of a set stands for quadrant q.
inline constexpr std::uint8_t kAllQuadrants = 0xF;

/// A vertex whose four faces are quads: the 3 x 3 array of control points around it. Below it,
/// Doo-Sabin is refinement of a uniform biquadratic B-spline: k levels down the vertex has become
/// N x N vertices, N = 2^k, at
///   sum_ab w_a(i) w_b(j) P_ab,  w_-(i) = (N-i)(N-i-1) / 2N^2,  w_+(i) = i(i+1) / 2N^2,
///   w_0 = 1 - w_- - w_+,
/// for i, j = 0 .. N - 1. Source: DESIGN section 5.
struct Patch {
  std::array<std::array<Vec3d, 3>, 3> points;  ///< [u][v]; the vertex itself is points[1][1]
  /// Faces that exist; where one is missing (at a free boundary) its opposite corner is not read.
  std::uint8_t quadrants = kAllQuadrants;
};

/// Three neighbours along a curve that is refined as a uniform quadratic B-spline: the middle one
/// becomes N points w_-(j) P_- + w_0(j) P_0 + w_+(j) P_+.
using CurvePoints = std::array<Vec3d, 3>;

/// Where w puts a point between its two neighbours along one axis, for index i of N.
struct PatchWeights {
  double minus;
  double zero;
  double plus;
  PatchWeights(std::int64_t i, std::int64_t n) {
    const double square = 2.0 * static_cast<double>(n) * static_cast<double>(n);
    minus = static_cast<double>(n - i) * static_cast<double>(n - i - 1) / square;
    plus = static_cast<double>(i) * static_cast<double>(i + 1) / square;
    zero = 1 - minus - plus;
  }
  Vec3d operator()(const Vec3d& a, const Vec3d& b, const Vec3d& c) const {
    return minus * a + zero * b + plus * c;
  }
};

/// The row of a patch at one place along u: its control points along v.
inline CurvePoints rowOf(const Patch& patch, const PatchWeights& u) {
  const auto& p = patch.points;
  return {u(p[0][0], p[1][0], p[2][0]), u(p[0][1], p[1][1], p[2][1]), u(p[0][2], p[1][2], p[2][2])};
}

/// A place t in 0 .. 1 along one axis of the smooth surface of a patch, the biquadratic B-spline
/// that its vertices come to lie on.
struct SplinePlace {
  double t;
  /// Of vertex i of n: where its limit point is.
  static SplinePlace ofVertex(std::int64_t i, std::int64_t n) {
    return {(static_cast<double>(i) + 0.5) / static_cast<double>(n)};
  }
  Vec3d value(const Vec3d& a, const Vec3d& b, const Vec3d& c) const {
    return (0.5 * (1 - t) * (1 - t)) * a + (0.5 + t * (1 - t)) * b + (0.5 * t * t) * c;
  }
  /// By differences: exactly 0 where points coincide.
  Vec3d slope(const Vec3d& a, const Vec3d& b, const Vec3d& c) const {
    return (1 - t) * (b - a) + t * (c - b);
  }
};

/// Unit normal of the plane of two tangents, on the side where they are counter-clockwise; 0 where
/// they are none up to rounding.
inline Vec3d normalOfTangents(const Vec3d& a, const Vec3d& b) {
  constexpr double kNoSine = 1e-12;
  const Vec3d normal = a.cross(b);
  if (!(normal.squaredNorm() > kNoSine * kNoSine * (a.squaredNorm() * b.squaredNorm())))
    return Vec3d::Zero();
  return normal.stableNormalized();
}

/// Exact normals of the smooth surface of a patch, at one place along u. A patch without some of
/// its faces must be `continued`.
class LimitNormals {
 public:
  LimitNormals(const Patch& patch, SplinePlace u) {
    for (std::size_t v = 0; v < 3; ++v) {
      const Vec3d &a = patch.points[0][v], &b = patch.points[1][v], &c = patch.points[2][v];
      values_[v] = u.value(a, b, c);
      slopes_[v] = u.slope(a, b, c);
    }
  }
  /// Unit, on the side where u and v are counter-clockwise: outside; 0 where there is none.
  Vec3d at(SplinePlace v) const {
    return normalOfTangents(v.value(slopes_[0], slopes_[1], slopes_[2]),
                            v.slope(values_[0], values_[1], values_[2]));
  }

 private:
  CurvePoints values_, slopes_;
};

/// The patch with the points of missing faces put where the surface goes on straight.
Patch continued(const Patch& partial);

/// Receives the vertices of a subdivided surface, each at the level where its neighbourhood is
/// fine enough. Coordinates are in index space (voxels).
class SurfaceSink {
 public:
  virtual ~SurfaceSink() = default;
  /// Vertices of one level.
  virtual void points(std::span<const Vec3d> points, int level) = 0;
  /// What a vertex of `level` - k has become, k levels down. Some quadrants may be missing.
  virtual void patch(const Patch& patch, int k, int level) = 0;
  /// The same for a vertex of the boundary.
  virtual void curve(const CurvePoints& points, int k, int level) = 0;
};

}  // namespace vox
