#pragma once

#include "libvox/core/types.h"

#include <openvdb/math/Coord.h>

#include <cmath>

namespace vox {

/// Voxel that holds a position (index space, |coordinate| < 2^31): each coordinate rounded, halves
/// up. The one rounding rule of the program.
inline openvdb::Coord voxelOf(const Vec3d& positionIndex) {
  const auto round = [](double x) { return static_cast<openvdb::Int32>(std::floor(x + 0.5)); };
  return {round(positionIndex.x()), round(positionIndex.y()), round(positionIndex.z())};
}

}  // namespace vox
