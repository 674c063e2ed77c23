#pragma once

#include "libvox/core/types.h"

#include <cstdint>

namespace vox {

/// The part of a voxel's cube (side 1) on the inner side of a plane.
/// @param distance  of the cube's centre from the plane, voxels; negative on the inner side
/// @param normal    of the plane, unit
/// The error is below 1e-9. coverage(t, n) + coverage(-t, n) = 1.
double coverage(double distance, const Vec3d& normal);

/// Which of 4 x 4 x 4 places, evenly spread in the cube, are on the inner side of a plane.
/// @param normal  of the plane, unit, outward
std::uint64_t samplesBelow(double distance, const Vec3d& normal);

/// The part of a cube that is below one plane at least, of two sets of planes.
/// @param a, b                the part below each set
/// @param samplesA, samplesB  the samples below it; they tell how much of both parts is the same
double unitedPart(double a, std::uint64_t samplesA, double b, std::uint64_t samplesB);

/// The part of a voxel's cube within half a voxel of a plane.
double shellCoverage(double distance, const Vec3d& normal);

}  // namespace vox
