#pragma once

#include "libvox/core/types.h"

namespace vox {

/// The part of a voxel's cube (side 1) on the inner side of a plane.
/// @param distance  of the cube's centre from the plane, voxels; negative on the inner side
/// @param normal    of the plane, unit
/// The error is below 1e-9. coverage(t, n) + coverage(-t, n) = 1.
double coverage(double distance, const Vec3d& normal);

/// The part of a voxel's cube within half a voxel of a plane.
double shellCoverage(double distance, const Vec3d& normal);

}  // namespace vox
