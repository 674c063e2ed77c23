#pragma once

#include "libvox/grid/openvdb_fwd.h"
#include "libvox/mesh/polygon_mesh.h"

#include <functional>
#include <memory>

namespace vox {

/// What a narrow band of distances is measured from.
enum class DistanceTo {
  kSolid,    ///< a closed surface, whichever way it faces: negative inside
  kSheet,    ///< a sheet one voxel thick around the surface: negative in it
  kSurface,  ///< the surface, without sign
};

/// Narrow band of distances in world units: active where they are smaller than the band, which is
/// the background (with a minus sign inside a solid).
///
/// @param polygons   triangles and quads, in index space of `transform`
/// @param band       half width in voxels, 1 or more
/// @param cancelled  asked from time to time; the grid is of no use once it says yes
///
/// Parallel; the result does not depend on the number of threads.
std::shared_ptr<openvdb::FloatGrid> distanceGrid(const PolygonMesh& polygons,
                                                 const openvdb::math::Transform& transform,
                                                 double band, DistanceTo what,
                                                 const std::function<bool()>& cancelled);

/// Bytes that making one takes, and that it has in the end, from the area in square voxels, by and
/// large.
struct DistanceBytes {
  double peak;
  double grid;
};
DistanceBytes bytesOfDistances(double area, double band);

}  // namespace vox
