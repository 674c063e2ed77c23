#pragma once

#include "libvox/core/types.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cstdint>
#include <span>

namespace vox {

/// The set of all four faces around a vertex. Bit q stands for quadrant q: quadrant 0 lies at u-,
/// v-, quadrant 1 at u-, v+, quadrant 2 at u+, v-, quadrant 3 at u+, v+.
inline constexpr std::uint8_t kAllQuadrants = 0xF;

/// A regular vertex: one whose four faces are quads. The patch is the 3 x 3 array of control points
/// around it. Doo-Sabin refines a patch like a uniform biquadratic B-spline: k levels down, the
/// vertex has become N x N vertices, N = 2^k, at
///   sum_ab w_a(i) w_b(j) P_ab,  w_-(i) = (N-i)(N-i-1) / 2N^2,  w_+(i) = i(i+1) / 2N^2,
///   w_0 = 1 - w_- - w_+,
/// for i, j = 0 .. N - 1. Source: DESIGN section 6.
struct Patch {
  std::array<std::array<Vec3d, 3>, 3> points;  ///< [u][v]; the vertex itself is points[1][1]
  /// The faces that exist. Of a missing face (at a free boundary), the corner opposite the vertex
  /// has no meaning.
  std::uint8_t quadrants = kAllQuadrants;
};

/// Three successive control points P_-, P_0, P_+ of a uniform quadratic B-spline curve. k levels
/// down, the middle one has become N = 2^k points w_-(j) P_- + w_0(j) P_0 + w_+(j) P_+, with the
/// weights of Patch.
using CurvePoints = std::array<Vec3d, 3>;

/// The weights w_-, w_0, w_+ of Patch for index i of N.
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
  /// The weighted sum of three successive points.
  Vec3d operator()(const Vec3d& a, const Vec3d& b, const Vec3d& c) const {
    return minus * a + zero * b + plus * c;
  }
};

/// Control points along v of the row of a patch whose weights along u are given.
inline CurvePoints rowOf(const Patch& patch, const PatchWeights& u) {
  const auto& p = patch.points;
  return {u(p[0][0], p[1][0], p[2][0]), u(p[0][1], p[1][1], p[2][1]), u(p[0][2], p[1][2], p[2][2])};
}

/// A parameter t in 0 .. 1 along one axis of the limit surface of a patch, a biquadratic B-spline.
struct SplinePlace {
  double t;
  /// Point of the spline with three successive control points.
  Vec3d value(const Vec3d& a, const Vec3d& b, const Vec3d& c) const {
    return (0.5 * (1 - t) * (1 - t)) * a + (0.5 + t * (1 - t)) * b + (0.5 * t * t) * c;
  }
  /// Derivative of the spline. Computed from differences, so that it is exactly 0 for equal points.
  Vec3d slope(const Vec3d& a, const Vec3d& b, const Vec3d& c) const {
    return (1 - t) * (b - a) + t * (c - b);
  }
};

/// Unit vector along a x b; 0 if the tangents are parallel up to rounding, or one of them is 0.
inline Vec3d normalOfTangents(const Vec3d& a, const Vec3d& b) {
  constexpr double kNoSine = 1e-12;
  const Vec3d normal = a.cross(b);
  if (!(normal.squaredNorm() > kNoSine * kNoSine * (a.squaredNorm() * b.squaredNorm())))
    return Vec3d::Zero();
  return normal.stableNormalized();
}

/// A point of the limit surface of a patch.
struct SplinePoint {
  Vec3d point;
  Vec3d normal;  ///< unit, outward (u, v and the normal are right-handed); 0 if there is none
};

/// @param controls  of a patch that has all four faces, or comes from continued()
SplinePoint splinePoint(const std::array<std::array<Vec3d, 3>, 3>& controls, SplinePlace u,
                        SplinePlace v);

/// The patch with all four faces: control points of missing faces are placed so that the surface
/// goes on straight.
Patch continued(const Patch& partial);

/// Receives the vertices of a subdivided surface, each at the level at which the faces around it
/// are fine enough. Coordinates are in index space (unit: voxels).
class SurfaceSink {
 public:
  virtual ~SurfaceSink() = default;
  /// Vertices of `level`.
  virtual void points(std::span<const Vec3d> points, int level) = 0;
  /// The 2^k x 2^k vertices of `level` that a regular vertex of level - k has become. Quadrants of
  /// the patch may be missing.
  virtual void patch(const Patch& patch, int k, int level) = 0;
  /// The 2^k boundary vertices of `level` that a boundary vertex of level - k has become.
  virtual void curve(const CurvePoints& points, int k, int level) = 0;
};

}  // namespace vox
