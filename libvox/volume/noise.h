#pragma once

#include "libvox/core/types.h"

#include <cstdint>

namespace vox {

/// A cell of the unit lattice along one axis, and a position in it.
struct LatticeCell {
  std::int64_t cell;
  double inside;  ///< position in the cell, 0 <= inside < 1
};
/// The cell of a coordinate. All coordinates above 2^52 are in one cell, because doubles resolve no
/// positions there; so are all below -2^52.
LatticeCell latticeCell(double x);

/// A hash of a cell, 64 well-mixed bits. Integers only: the same bits on every processor.
std::uint64_t hashOfCell(std::int64_t i, std::int64_t j, std::int64_t k, std::uint32_t seed);

/// Gradient noise, from -1 to 1: smooth (second derivatives are continuous), 0 at the points of the
/// unit lattice, positive as often as negative. Only + - * and floor: the same bits on every
/// processor. Source: K. Perlin, Improving noise, 2002, with hashOfCell as the hash.
double gradientNoise(const Vec3d& p, std::uint32_t seed);

/// Sum of `octaves` noises, from -1 to 1. Each has twice the frequency and half the height of the
/// one before.
double fractalNoise(const Vec3d& p, int octaves, std::uint32_t seed);

}  // namespace vox
