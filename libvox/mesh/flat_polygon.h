#pragma once

#include "libvox/core/types.h"

#include <cstdint>
#include <span>
#include <vector>

namespace vox {

__extension__ using Int128 = __int128;

/// A position projected onto a plane, on a lattice. Coordinates have less than 51 bits, so that the
/// functions below are exact.
struct FlatPoint {
  std::int64_t x, y;
  auto operator<=>(const FlatPoint&) const = default;
};

/// Twice the area of the triangle a, b, c: positive if a, b, c turn left, negative if they turn
/// right, 0 if they are on a line.
inline Int128 turn(const FlatPoint& a, const FlatPoint& b, const FlatPoint& c) {
  return Int128{b.x - a.x} * (c.y - a.y) - Int128{b.y - a.y} * (c.x - a.x);
}

double squaredDistance(const FlatPoint& a, const FlatPoint& b);

/// Positions projected along a direction and scaled, so that they fill the lattice around the first
/// one. A polygon whose area vector has the direction runs counter-clockwise.
/// @param normal  need not have length 1; without a length any direction is taken
std::vector<FlatPoint> flattened(std::span<const Vec3d> positions, const Vec3d& normal);

/// Area vector of a polygon in space, doubled (area_vector.h).
Vec3d twiceAreaVector(std::span<const Vec3d> corners);

}  // namespace vox
