#pragma once

#include "libvox/core/types.h"
#include "libvox/grid/openvdb.h"
#include "libvox/render/camera.h"
#include "libvox/render/ray_cast.h"
#include "libvox/render/shading_options.h"
#include "libvox/render/visible.h"
#include "libvox/volume/shading_normals.h"

#include <functional>
#include <memory>
#include <optional>

namespace vox {

/// Linear red, green and blue.
using Light = Eigen::Vector3d;

/// Colours of points on a surface that a camera sees. They reflect, diffusely, a lamp above the
/// left shoulder, a weak lamp from the right, and a bright sky where the surface does not hide it.
/// Not thread-safe; make one per task.
class Shader {
 public:
  Shader(const VisibleGrids& visible, const RayCaster& surface, const ViewAxes& axes,
         const ShadingOptions& options);

  /// Light reflected along a line of sight; empty if it misses the surface.
  /// @param sample   number of the sample at its pixel, 0 .. samples - 1
  /// @param samples  number of samples at a pixel: they share the occlusion rays
  std::optional<Light> look(const Sight& sight, int sample, int samples);

 private:
  using Vectors = openvdb::tree::ValueAccessor<const openvdb::Vec3STree>;

  /// Normals and directions in index space.
  Vec3d normalAt(const RayHit& hit, const Vec3d& direction);
  std::optional<Vec3d> storedNormal(const openvdb::Coord& voxel);
  Light colorAt(const openvdb::Coord& voxel);
  /// Part of the sky that the surface does not hide, 0 .. 1.
  double skyAt(const IndexRay& ray, const RayHit& hit, const Vec3d& normal, int sample,
               int samples);

  ShadingOptions options_;
  ViewAxes axes_;
  std::unique_ptr<RayCaster> surface_;
  openvdb::math::MapBase::ConstPtr map_;
  std::optional<CongradientNormals> congradient_;
  std::optional<Vectors> normals_;
  std::optional<Vectors> colors_;
  std::function<std::optional<openvdb::Vec3f>(const openvdb::Coord&)> computedColors_;
  double occlusionReach_;  // voxels
};

}  // namespace vox
