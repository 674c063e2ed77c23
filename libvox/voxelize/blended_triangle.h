#pragma once

#include "libvox/core/types.h"

#include <Eigen/Geometry>

#include <array>
#include <cmath>

namespace vox {

/// A triangle with a normal at each corner, blended linearly in between.
class BlendedTriangle {
 public:
  BlendedTriangle() = default;
  /// @param normals  unit, or 0: the corner then gets `flat`
  /// @param flat     normal of the triangle; also used where the blended normals cancel
  BlendedTriangle(const std::array<Vec3d, 3>& corners, std::array<Vec3d, 3> normals,
                  const Vec3d& flat)
      : a_(corners[0]),
        ab_(corners[1] - corners[0]),
        ac_(corners[2] - corners[0]),
        flat_(flat),
        abAb_(ab_.squaredNorm()),
        abAc_(ab_.dot(ac_)),
        acAc_(ac_.squaredNorm()) {
    for (Vec3d& normal : normals)
      if (normal.isZero(0)) normal = flat;
    normal_ = normals[0];
    toB_ = normals[1] - normals[0];
    toC_ = normals[2] - normals[0];
  }

  /// Unit normal at the point of the triangle nearest to p.
  Vec3d normalNear(const Vec3d& p) const {
    const auto [b, c] = nearest(p);
    const Vec3d normal = normal_ + b * toB_ + c * toC_;
    const double square = normal.squaredNorm();
    constexpr double kLeast = 1e-6;  // below it, normals cancel each other
    return square > kLeast * kLeast ? Vec3d(normal / std::sqrt(square)) : flat_;
  }

 private:
  struct Weights {
    double b, c;
  };

  /// Weights of corners b and c in the point of the triangle nearest to p. Sides without length are
  /// never the nearest. Source: Ericson 2005, "Real-Time Collision Detection", section 5.1.5.
  Weights nearest(const Vec3d& p) const {
    const double ab = ab_.dot(p - a_);
    const double ac = ac_.dot(p - a_);
    if (ab <= 0 && ac <= 0) return {0, 0};
    const double abFromB = ab - abAb_;
    const double acFromB = ac - abAc_;
    if (abFromB >= 0 && acFromB <= abFromB) return {1, 0};
    const double abFromC = ab - abAc_;
    const double acFromC = ac - acAc_;
    if (acFromC >= 0 && abFromC <= acFromC) return {0, 1};
    const double inC = ab * acFromB - abFromB * ac;
    if (inC <= 0 && ab >= 0 && abFromB <= 0 && abAb_ > 0) return {ab / abAb_, 0};
    const double inB = abFromC * ac - ab * acFromC;
    if (inB <= 0 && ac >= 0 && acFromC <= 0 && acAc_ > 0) return {0, ac / acAc_};
    const double inA = abFromB * acFromC - abFromC * acFromB;
    const double fromB = acFromB - abFromB;
    const double fromC = abFromC - acFromC;
    if (inA <= 0 && fromB >= 0 && fromC >= 0 && fromB + fromC > 0)
      return {fromC / (fromB + fromC), fromB / (fromB + fromC)};
    const double sum = inA + inB + inC;
    if (!(sum > 0)) return {1.0 / 3, 1.0 / 3};
    return {inB / sum, inC / sum};
  }

  Vec3d a_, ab_, ac_;
  Vec3d normal_, toB_, toC_, flat_;
  double abAb_ = 0, abAc_ = 0, acAc_ = 0;
};

}  // namespace vox
