#pragma once

#include "libvox/core/types.h"

#include <cstdint>
#include <span>

namespace vox {

// Patterns of unit size. Only exact operations: the same bits on every processor.

/// i modulo n, 0 .. n - 1 for negative i too.
std::size_t cyclic(std::int64_t i, std::size_t n);

/// 0 .. n - 1: the colour of a unit cell, none of whose neighbours across faces has it.
std::size_t checkerAt(const Vec3d& p, std::size_t n);

/// 0 .. n - 1: the colour of a band of unit width.
std::size_t stripeAt(double x, std::size_t n);

/// Early wood to late wood within each unit ring: from 0 it rises to 1 over most of the ring and
/// falls back over the rest.
double ringAt(double radius);

/// 0 in the middle of veins, a unit apart, 1 half way between them, steepest at the veins.
double veinAt(double x);

/// Bricks of size 1 x 1/2 x 1/3 in running bond, courses along z.
struct BrickCell {
  bool mortar;
  std::uint64_t hash;  ///< of the brick
};
/// @param thickness  of the mortar, in heights of a brick
BrickCell brickAt(const Vec3d& p, double thickness, std::uint32_t seed);

/// The broken line from the first colour at t = 0 to the last at t = 1, constant beyond.
Vec3d rampAt(std::span<const Vec3d> colors, double t);

}  // namespace vox
