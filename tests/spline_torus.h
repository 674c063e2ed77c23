#pragma once

#include "libvox/core/types.h"

#include <array>
#include <vector>

namespace vox::test {

/// The limit surface of torusGrid(major, minor) in closed form: a biquadratic B-spline, periodic in
/// both directions, wound outward.
class SplineTorus {
 public:
  SplineTorus(int major, int minor);

  Vec3d at(double u, double v) const;  ///< u in [0, major), v in [0, minor)
  Vec3d normalAt(double u, double v) const;

  /// Volume inside: the integral of a polynomial over each patch, exact by Gauss' rule.
  double volume() const;

  /// Distance of a point near the surface from it, positive outside. Newton's method, starting from
  /// the nearest of many samples.
  double distance(const Vec3d& point) const;

  /// Normal at the point of the surface nearest to `point`, which must be near the surface.
  Vec3d normalNear(const Vec3d& point) const;

  /// Parameters u, v of the point of the surface nearest to `point`. Control point (i, j) belongs
  /// to u = i - 1/2, v = j - 1/2.
  std::array<double, 2> nearest(const Vec3d& point) const;

 private:
  struct Frame {
    Vec3d at, du, dv, duu, duv, dvv;
  };
  Frame frame(double u, double v) const;

  int major_, minor_;
  std::vector<Vec3d> controls_;
  static constexpr int kSamples = 4;  // per patch and direction
  std::vector<Vec3d> samples_;
};

}  // namespace vox::test
