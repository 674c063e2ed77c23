#pragma once

#include "libvox/core/types.h"

#include <Eigen/Geometry>

#include <cstddef>

namespace vox {

/// Twice the area vector of a polygon in space (Newell). It points to the side from which the
/// polygon looks counter-clockwise; its length is twice the area of the polygon projected along it.
/// Moving the polygon does not change it. For a quad it is the cross product of the diagonals.
/// @param corner  corner(i) is the position of corner i of n
template <class Corner>
Vec3d twiceAreaVector(std::size_t n, Corner&& corner) {
  Vec3d sum = Vec3d::Zero();
  for (std::size_t i = 2; i < n; ++i)
    sum += Vec3d(corner(i - 1) - corner(0)).cross(Vec3d(corner(i) - corner(0)));
  return sum;
}

}  // namespace vox
