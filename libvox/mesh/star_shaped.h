#pragma once

#include "libvox/core/types.h"

#include <span>

namespace vox {

/// Whether a polygon is star-shaped about the mean of its corners, the point to which Doo-Sabin
/// shrinks it: seen along the area vector, the triangle of the mean and each side runs
/// counter-clockwise. A triangle may run the other way round by 1e-9 of the square of the largest
/// distance from the mean. A polygon without area counts as star-shaped: it has no inside.
/// Convex polygons are star-shaped. Cost O(n).
bool isStarShaped(std::span<const Vec3d> corners);

/// Whether a polygon is star-shaped and turns counter-clockwise at each corner, seen along its area
/// vector and with the same tolerance. Cost O(n).
bool isConvex(std::span<const Vec3d> corners);

}  // namespace vox
