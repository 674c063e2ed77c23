#pragma once

#include "libvox/foot/cell.h"

namespace vox {

/// Fits the polynomials of a cell to the feet of 48 points in its prism. Sets everything but the
/// prism. The same bits on every processor.
/// @param frame  derivatives along a and b, and the unit normal, in the middle of the surface
/// @return whether the distance is right within 0.002 voxels there, and the foot within 0.02
bool fitFoot(const Biquadratic& surface, const std::array<Float3, 3>& frame, PolynomialCell& cell);

}  // namespace vox
