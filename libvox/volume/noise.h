#pragma once

#include "libvox/core/types.h"

#include <cstdint>

namespace vox {

/// A cell of the unit lattice and the place in it.
struct LatticeCell {
  std::int64_t cell;
  double inside;  ///< 0 <= inside < 1
};
/// Cells of more than 2^52 in size all count as one: a double resolves no place in them.
LatticeCell latticeCell(double x);

/// 64 well-mixed bits of a cell. Integers only: the same on every processor.
std::uint64_t hashOfCell(std::int64_t i, std::int64_t j, std::int64_t k, std::uint32_t seed);

/// Gradient noise: smooth (second derivatives are continuous), 0 at the points of the unit lattice,
/// within -1 and 1, without preferred sign. Only + - * and floor: the same bits on every processor.
/// Source: K. Perlin, Improving noise, 2002; the hash is our own.
double gradientNoise(const Vec3d& p, std::uint32_t seed);

/// Sum of `octaves` noises, each of twice the frequency and half the height of the one before,
/// scaled to lie within -1 and 1.
double fractalNoise(const Vec3d& p, int octaves, std::uint32_t seed);

}  // namespace vox
