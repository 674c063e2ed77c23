#pragma once

#include "libvox/core/types.h"

#include <openvdb/Types.h>

namespace vox {

/// The voxel that holds a position: each coordinate rounded to the nearest integer, halves up. All
/// code that rounds positions to voxels follows this rule.
/// @param positionIndex  index space; |coordinate| < 2^31
inline openvdb::Coord voxelOf(const Vec3d& positionIndex) {
  const auto round = [](double x) {
    const auto towardsZero =
        static_cast<openvdb::Int32>(x + 0.5);  // floor() is a call on old targets
    return towardsZero - (x + 0.5 < towardsZero ? 1 : 0);
  };
  return {round(positionIndex.x()), round(positionIndex.y()), round(positionIndex.z())};
}

}  // namespace vox
