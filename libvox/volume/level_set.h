#pragma once

#include "libvox/grid/openvdb_fwd.h"
#include "libvox/mesh/polygon_mesh.h"

#include <functional>
#include <memory>

namespace vox {

/// The object to which distances are measured.
enum class DistanceTo {
  kSolid,    ///< a closed surface, of any winding; distances inside are negative
  kSheet,    ///< a sheet one voxel thick around the surface; distances inside it are negative
  kSurface,  ///< the surface; distances have no sign
};

/// Narrow band of distances in world units. Voxels whose distance is smaller than the band are
/// active. The background is the band; inside a solid it is negative.
///
/// @param polygons   triangles and quads, in the index space of `transform`
/// @param band       half width in voxels, at least 1
/// @param cancelled  called now and then, by any thread; if it returns true, the work ends and the
///   grid must not be used
///
/// Parallel; result independent of thread count.
std::shared_ptr<openvdb::FloatGrid> distanceGrid(const PolygonMesh& polygons,
                                                 const openvdb::math::Transform& transform,
                                                 double band, DistanceTo what,
                                                 const std::function<bool()>& cancelled);

/// Memory of a band of distances.
struct DistanceBytes {
  double peak;  ///< while it is made
  double grid;  ///< in the end
};
/// Estimate of the memory of a band.
/// @param area  of the surface, in square voxels
/// @param band  half width in voxels
DistanceBytes bytesOfDistances(double area, double band);

}  // namespace vox
