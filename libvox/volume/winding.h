#pragma once

#include "libvox/grid/openvdb_fwd.h"
#include "libvox/mesh/polygon_mesh.h"

#include <span>
#include <vector>

namespace vox {

/// Winding numbers of closed surfaces around the centres of some voxels: +1 for each surface that
/// faces outward and has the centre inside, -1 for each one that faces inward.
///
/// @param surfaces  triangles and quads (cut in two along 0-2), in index space
///
/// Exact unless the centre is on the surface up to rounding. Parallel; result independent of thread
/// count. Cost O(T log Q + A) for Q voxels and T triangles that cover A columns of voxels along x.
std::vector<int> windingNumbers(const PolygonMesh& surfaces,
                                std::span<const openvdb::Coord> voxels);

}  // namespace vox
