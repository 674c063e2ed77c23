#pragma once

#include "libvox/core/types.h"

#include <cstdint>
#include <span>

namespace vox {

// Patterns of unit size. They use only operations that IEEE 754 defines exactly: the same bits on
// every processor.

/// i modulo n, from 0 to n - 1 also for negative i.
std::size_t cyclic(std::int64_t i, std::size_t n);

/// Number of the colour, 0 .. n - 1, of the unit cell that holds p. Cells that share a face have
/// different colours.
std::size_t checkerAt(const Vec3d& p, std::size_t n);

/// Number of the colour, 0 .. n - 1, of the band of unit width that holds x.
std::size_t stripeAt(double x, std::size_t n);

/// Early wood (0) to late wood (1) in rings of unit width: rises from 0 to 1 over most of a ring
/// and falls back to 0 over the rest.
double ringAt(double radius);

/// Distance from veins, which are a unit apart: 0 in the middle of a vein, 1 half way between two;
/// steepest at the veins.
double veinAt(double x);

/// A point in brickwork.
struct BrickCell {
  bool mortar;         ///< whether the point is in the mortar
  std::uint64_t hash;  ///< of the brick
};
/// The brickwork at p: bricks of size 1 x 1/2 x 1/3 in running bond, courses stacked along z.
/// @param thickness  of the mortar, in heights of a brick
BrickCell brickAt(const Vec3d& p, double thickness, std::uint32_t seed);

/// Colour at t on the broken line through all colours, from the first one at t = 0 to the last one
/// at t = 1; constant beyond.
Vec3d rampAt(std::span<const Vec3d> colors, double t);

}  // namespace vox
