// Volume of a cube below a plane. Source: Scardovelli & Zaleski 2000, "Analytical relations
// connecting linear interfaces and volume fractions in rectangular grids".

#include "libvox/volume/coverage.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace vox {
namespace {

/// Volume of the points x of the cube [0, 1]^3 with m . x < height.
/// @param m       ascending, not negative, sum 1
/// @param height  from 0 to 1/2
double volumeBelow(const Vec3d& m, double height) {
  const double both = m[0] + m[1];
  const auto square = [](double x) { return x * x; };
  // The part of the cubic formula that belongs to a corner which the plane has passed.
  const auto passed = [&](double corner) { return square(corner) * (corner - 3 * height); };
  if (height < m[0]) return square(height) * height / (6 * m[0] * m[1] * m[2]);
  if (height < m[1])
    return height * (height - m[0]) / (2 * m[1] * m[2]) + square(m[0]) / (6 * m[1] * m[2]);
  if (height < std::min(both, m[2]))
    return (square(height) * (3 * both - height) + passed(m[0]) + passed(m[1])) /
           (6 * m[0] * m[1] * m[2]);
  if (m[2] < both)
    return (square(height) * (3 - 2 * height) + passed(m[0]) + passed(m[1]) + passed(m[2])) /
           (6 * m[0] * m[1] * m[2]);
  return (2 * height - both) / (2 * m[2]);
}

}  // namespace

double coverage(double distance, const Vec3d& normal) {
  // A component so small changes the volume by its square, but dividing by it costs digits.
  constexpr double kLeast = 1e-5;
  Vec3d m = normal.cwiseAbs();
  std::sort(m.begin(), m.end());
  for (double& component : m)
    if (component < kLeast) component = 0;
  const double width = m.sum();
  const double height = 0.5 - std::abs(distance) / width;
  const double part = height > 0 ? volumeBelow(m / width, height) : 0;
  return distance > 0 ? part : 1 - part;
}

std::uint64_t samplesBelow(double distance, const Vec3d& normal) {
  constexpr int kSide = 4;
  std::uint64_t below = 0;
  for (int i = 0; i < kSide * kSide * kSide; ++i) {
    const Vec3d cell(i % kSide, i / kSide % kSide, i / (kSide * kSide));
    const Vec3d offset = (cell + Vec3d::Constant(0.5)) / kSide - Vec3d::Constant(0.5);
    if (distance + normal.dot(offset) < 0) below |= std::uint64_t{1} << i;
  }
  return below;
}

double unitedPart(double a, std::uint64_t samplesA, double b, std::uint64_t samplesB) {
  if (samplesB == 0) return std::max(a, b);
  const double common = static_cast<double>(std::popcount(samplesA & samplesB)) /
                        static_cast<double>(std::popcount(samplesB));
  return std::clamp(a + b * (1 - common), std::max(a, b), 1.0);
}

double shellCoverage(double distance, const Vec3d& normal) {
  return coverage(distance - 0.5, normal) - coverage(distance + 0.5, normal);
}

}  // namespace vox
