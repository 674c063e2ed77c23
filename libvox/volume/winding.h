#pragma once

#include "libvox/grid/openvdb_fwd.h"
#include "libvox/mesh/polygon_mesh.h"

#include <span>
#include <vector>

namespace vox {

/// How often closed surfaces wind around the centres of some voxels: +1 inside one that faces
/// outward, -1 inside one that faces inward.
///
/// @param surfaces  triangles and quads (two triangles, along 0-2), in index space
/// Exact where the centre is not on the surface, up to rounding. Parallel; the result does not
/// depend on the number of threads. Cost O(T log Q + A) for T triangles that cover A columns of
/// voxels seen along x.
std::vector<int> windingNumbers(const PolygonMesh& surfaces,
                                std::span<const openvdb::Coord> voxels);

}  // namespace vox
