#pragma once

#include "libvox/mesh/limit_piece.h"

#include <array>
#include <cmath>
#include <cstddef>

namespace vox {

using Float3 = std::array<float, 3>;

inline float dot(const Float3& a, const Float3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
inline Float3 cross(const Float3& a, const Float3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline float length(const Float3& a) {
  return std::sqrt(dot(a, a));
}

/// A biquadratic map of the square -1 <= a, b <= 1: the sum of c[p + 3q] a^p b^q.
using Biquadratic = std::array<Float3, 9>;

/// Position and derivatives of a biquadratic map.
struct Jet {
  Float3 s, sa, sb;
  Jet(const Biquadratic& c, float a, float b) {
    for (std::size_t x = 0; x < 3; ++x) {
      const float r1 = c[3][x] + a * (c[4][x] + a * c[5][x]);
      const float r2 = c[6][x] + a * (c[7][x] + a * c[8][x]);
      const float d0 = c[1][x] + 2 * a * c[2][x];
      const float d1 = c[4][x] + 2 * a * c[5][x];
      const float d2 = c[7][x] + 2 * a * c[8][x];
      s[x] = c[0][x] + a * (c[1][x] + a * c[2][x]) + b * (r1 + b * r2);
      sa[x] = d0 + b * (d1 + b * d2);
      sb[x] = r1 + 2 * b * r2;
    }
  }
  /// Outward, not normalized.
  Float3 normal() const { return cross(sa, sb); }
};

/// A part of the parameters of a piece.
struct ParameterBox {
  double u0 = 0, u1 = 1, v0 = 0, v1 = 1;
};

/// A part of a piece as a map of -1 <= a, b <= 1, in double precision.
std::array<Vec3d, 9> coefficientsOf(const std::array<std::array<Vec3d, 3>, 3>& points,
                                    const ParameterBox& part);

}  // namespace vox
