#pragma once

#include "libvox/subdivide/level.h"

#include <cstdint>
#include <vector>

namespace vox {

/// Image vertices of one Doo-Sabin step: one per corner, in corner order. They are the points of
/// the next level. If this is the first level of an extended mesh, two Chaikin points per boundary
/// edge follow, in the order of the boundary corners.
///
/// Cost O(C): a face of n corners needs three sums (centroid, cosines, sines), not n^2 products.
/// Parallel; result independent of thread count.
/// Source: Doo & Sabin 1978; paper section 2.1, eq. (1); strip faces: DESIGN section 4.
std::vector<Vec3d> imageVertices(const SubdivisionLevel& level);

/// Number of points of the next level.
std::uint64_t nextPointCount(const SubdivisionLevel& level);

}  // namespace vox
