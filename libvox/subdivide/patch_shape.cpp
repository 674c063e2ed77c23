// Normals for the measures of patches.

#include "libvox/subdivide/patch_shape.h"

#include <Eigen/Geometry>

namespace vox {

Vec3d normalOf(const Vec3d& alongU, const Vec3d& alongV) {
  const Vec3d normal = alongU.cross(alongV).stableNormalized();
  return normal.squaredNorm() > 0.5 ? normal : Vec3d::Zero();
}

}  // namespace vox
