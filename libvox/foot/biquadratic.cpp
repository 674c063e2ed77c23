// Parts of a biquadratic B-spline in powers of their parameters.

#include "libvox/foot/biquadratic.h"

namespace vox {
namespace {

/// Weights of three successive control points in the coefficients of 1, a, a^2 of a spline over
/// u = middle + half a.
std::array<std::array<double, 3>, 3> powerWeights(double low, double high) {
  const double u = (low + high) / 2;
  const double h = (high - low) / 2;
  const double minus = (1 - u) * (1 - u) / 2;
  const double plus = u * u / 2;
  return {{{minus, 1 - minus - plus, plus},
           {-h * (1 - u), h * (1 - 2 * u), h * u},
           {h * h / 2, -h * h, h * h / 2}}};
}

}  // namespace

std::array<Vec3d, 9> coefficientsOf(const std::array<std::array<Vec3d, 3>, 3>& points,
                                    const ParameterBox& part) {
  const auto alongU = powerWeights(part.u0, part.u1);
  const auto alongV = powerWeights(part.v0, part.v1);
  std::array<Vec3d, 9> c;
  for (std::size_t p = 0; p < 3; ++p) {
    std::array<Vec3d, 3> row;
    for (std::size_t v = 0; v < 3; ++v)
      row[v] =
          alongU[p][0] * points[0][v] + alongU[p][1] * points[1][v] + alongU[p][2] * points[2][v];
    for (std::size_t q = 0; q < 3; ++q)
      c[p + 3 * q] = alongV[q][0] * row[0] + alongV[q][1] * row[1] + alongV[q][2] * row[2];
  }
  return c;
}

}  // namespace vox
