#pragma once

#include "libvox/core/types.h"

#include <array>
#include <cstddef>
#include <optional>
#include <span>

namespace vox {

/// A polynomial of degree 4 in a and b: the terms of a^i b^j, by the power j, then by i. A number
/// is a float, a double, or a vector of floats.
template <class Number>
using Quartic = std::array<Number, 15>;

/// A height and its derivatives.
struct HeightSlope {
  double height, alongA, alongB;
};
HeightSlope heightAt(const Quartic<double>& terms, double a, double b);

inline constexpr std::size_t kLeastOfStar = 5;  ///< triangles
inline constexpr std::size_t kMostOfStar = 8;
/// Slopes of a patch may be off by this many times the tolerance in voxels, and by no more than
/// kMostSlopeError, at the limit points of faces.
inline constexpr double kSlopeError = 10;
inline constexpr double kMostSlopeError = 0.1;

/// A part of a surface as a height above a rectangle, in voxels.
struct HeightPatch {
  Vec3d middle;                ///< of the rectangle
  std::array<Vec3d, 3> axes;   ///< unit: along a, along b, and up; right-handed
  std::array<double, 2> half;  ///< half sides of the rectangle
  Quartic<double> height;      ///< a, b from -1 to 1
  /// Half planes around the star, s[0] x + s[1] y <= s[2] for x, y from
  /// the middle along the axes; (s[0], s[1]) is a unit vector.
  std::array<std::array<double, 3>, kMostOfStar> sides = {};
  std::size_t sideCount = 0;
  double low = 0, high = 0;             ///< of the height, at some places
  std::array<double, 2> steepest = {};  ///< slopes along the axes, at some places
};

/// The vertices around a vertex within triangles, counter-clockwise.
struct TriangleStar {
  Vec3d centre;
  std::span<const Vec3d> ring;   ///< the neighbours of the vertex
  std::span<const Vec3d> outer;  ///< of each edge from ring[k] to ring[k + 1]: the vertex beyond it
};

/// The limit surface of all corners at a vertex within triangles, and a little more, by least
/// squares through limit points in these and at the edges around them.
/// @param star       kLeastOfStar to kMostOfStar triangles, and as many beyond them
/// @param longest    side of the rectangle, voxels
/// @param tolerance  largest distance, along the third axis, of those limit points from the patch,
///   voxels
/// @return nothing if the rectangle around the corners is longer, or tiny, the surface is steep
/// above it or
///   is no height, or a limit point or a normal is farther off
/// Source: DESIGN section 18.
std::optional<HeightPatch> fitStar(const TriangleStar& star, double longest, double tolerance);

}  // namespace vox
