#pragma once

#include "libvox/core/types.h"
#include "libvox/grid/openvdb.h"
#include "libvox/render/camera.h"

#include <openvdb/math/Ray.h>

#include <limits>
#include <memory>
#include <optional>

namespace vox {

/// A ray in index space; times are multiples of its direction.
using IndexRay = openvdb::math::Ray<double>;

/// Components of the direction that are rounding errors become 0: a ray along an axis stays on it.
IndexRay indexRay(const Vec3d& origin, const Vec3d& direction,
                  double start = openvdb::math::Delta<double>::value(),
                  double end = std::numeric_limits<double>::max());
/// A line of sight in index space; its direction is a unit vector there.
IndexRay indexRay(const Sight& sight, const openvdb::math::MapBase& toWorld);

struct RayHit {
  double time = 0;
  openvdb::Coord voxel;  ///< the voxel that was hit, or the voxel that holds the point of the hit
  Vec3d face;  ///< unit outward normal at the hit, index space: of the side of a voxel, or of an
               ///< isosurface
};

/// A surface that rays can hit. Not thread-safe: a task makes a copy.
class RayCaster {
 public:
  virtual ~RayCaster() = default;

  /// The first hit between the times of the ray, which must be positive.
  virtual std::optional<RayHit> firstHit(const IndexRay& ray) = 0;

  /// Cheap beside the work of a task.
  virtual std::unique_ptr<RayCaster> copy() const = 0;
};

/// Active voxels as solid unit cubes around their index, through OpenVDB's digital differential
/// analyzers level by level: empty nodes are passed in one step.
/// @param voxels  must outlive the caster
std::unique_ptr<RayCaster> voxelCaster(const openvdb::MaskTree& voxels);

/// The zero isosurface of a level set, within the cell to linear precision.
/// @param levelSet  must outlive the caster
/// @throws InputError  its voxels are no cubes, or its narrow band does not hold 0
std::unique_ptr<RayCaster> levelSetCaster(const openvdb::FloatGrid& levelSet);

}  // namespace vox
