#pragma once

#include "libvox/core/types.h"
#include "libvox/mesh/polygon_mesh.h"

#include <span>
#include <vector>

namespace vox {

/// Numbers of some points in the order in which a Z-order curve through their box meets them
/// (Morton 1966). Points in one cell of the curve, 2^-21 of the box, keep their order. Parallel.
std::vector<Index> spatialOrder(std::span<const Vec3d> points);

/// Whether faces or points of a large mesh lie in no order, so that neighbours are far apart in
/// memory. Parallel.
bool isScattered(const PolygonMesh& mesh);

}  // namespace vox
