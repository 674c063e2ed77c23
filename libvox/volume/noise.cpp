// Gradient noise. K. Perlin, Improving noise, 2002.

#include "libvox/volume/noise.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace vox {
namespace {

/// A bijection of 64 bits. Each bit of the input changes about half of the bits of the output.
/// Source: the finalizer of SplitMix64 (G. Steele, D. Lea, C. Flood, Fast splittable pseudorandom
/// number generators, 2014).
std::uint64_t mixed(std::uint64_t x) {
  x = (x ^ x >> 30U) * 0xbf58476d1ce4e5b9ULL;
  x = (x ^ x >> 27U) * 0x94d049bb133111ebULL;
  return x ^ x >> 31U;
}

/// Smooth step: 0 at 0, 1 at 1; first and second derivatives are 0 at both ends.
double fade(double t) {
  return t * t * t * (t * (t * 6 - 15) + 10);
}

double between(double a, double b, double t) {
  return a + t * (b - a);
}

/// Dot product of (x, y, z) and one of the 12 directions to the edges of a cube, chosen by 4 bits
/// of the hash. Four directions are chosen by two values, to make it 16.
double alongGradient(std::uint64_t hash, double x, double y, double z) {
  const std::uint64_t h = hash & 15U;
  const double u = h < 8 ? x : y;
  const double v = h < 4 ? y : h == 12 || h == 14 ? x : z;
  return ((h & 1U) == 0 ? u : -u) + ((h & 2U) == 0 ? v : -v);
}

/// Upper bound of the magnitude of improved noise.
constexpr double kLargest = 1.04;

}  // namespace

LatticeCell latticeCell(double x) {
  constexpr double kMost = 4503599627370496;  // 2^52
  if (!(std::abs(x) < kMost)) return {static_cast<std::int64_t>(x < 0 ? -kMost : kMost), 0};
  const double cell = std::floor(x);
  return {static_cast<std::int64_t>(cell), x - cell};
}

std::uint64_t hashOfCell(std::int64_t i, std::int64_t j, std::int64_t k, std::uint32_t seed) {
  constexpr std::uint64_t kGolden = 0x9e3779b97f4a7c15ULL;
  std::uint64_t hash = mixed(seed + kGolden);
  for (const std::int64_t n : {i, j, k})
    hash = mixed(hash + kGolden + static_cast<std::uint64_t>(n));
  return hash;
}

double gradientNoise(const Vec3d& p, std::uint32_t seed) {
  const LatticeCell x = latticeCell(p.x());
  const LatticeCell y = latticeCell(p.y());
  const LatticeCell z = latticeCell(p.z());
  std::array<double, 8> corner;
  for (unsigned n = 0; n < 8; ++n) {
    const int i = n & 1U, j = n >> 1U & 1U, k = n >> 2U;
    corner[n] = alongGradient(hashOfCell(x.cell + i, y.cell + j, z.cell + k, seed), x.inside - i,
                              y.inside - j, z.inside - k);
  }
  const double u = fade(x.inside);
  const double v = fade(y.inside);
  const double near =
      between(between(corner[0], corner[1], u), between(corner[2], corner[3], u), v);
  const double far = between(between(corner[4], corner[5], u), between(corner[6], corner[7], u), v);
  return std::clamp(between(near, far, fade(z.inside)) / kLargest, -1.0, 1.0);
}

double fractalNoise(const Vec3d& p, int octaves, std::uint32_t seed) {
  double sum = 0;
  double heights = 0;
  double frequency = 1;
  for (int n = 0; n < octaves; ++n, frequency *= 2) {
    sum += gradientNoise(p * frequency, seed + static_cast<std::uint32_t>(n)) / frequency;
    heights += 1 / frequency;
  }
  return sum / heights;
}

}  // namespace vox
