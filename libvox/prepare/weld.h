#pragma once

#include "libvox/core/origins.h"
#include "libvox/core/types.h"

#include <cstdint>
#include <vector>

namespace vox {

/// For each point, the point that it is welded to; itself if it stays. Points that are not `used`
/// stay, and no point is welded to them.
///
/// Tolerance 0: points with equal coordinates (-0 equals +0) are welded to the lowest-numbered one.
/// Tolerance > 0 (Euclidean, in units of the points): the points are visited in order of their
/// numbers. Each is welded to the lowest-numbered point within the tolerance that has stayed, or
/// stays if there is none. So welds never chain: no point moves further than the tolerance, and
/// points that stay are further apart than it. The result does not depend on thread count.
///
/// Cost O(V log V), parallel; with a tolerance O(V) expected.
/// @throws UsageError  the tolerance is negative or not finite
Origins weldTargets(const std::vector<Vec3d>& points, const std::vector<std::uint8_t>& used,
                    double tolerance);

}  // namespace vox
