#pragma once

#include "libvox/foot/cell.h"

#include <Eigen/Geometry>

#include <array>

namespace vox {

inline Float3 asFloats(const Vec3d& v) {
  return {static_cast<float>(v.x()), static_cast<float>(v.y()), static_cast<float>(v.z())};
}

/// Axes of a triangle: along its longest side, across, and (nearly) along a given normal.
struct TriangleFrame {
  std::array<Vec3d, 3> axes;
  TriangleFrame(const std::array<Vec3d, 3>& points, const Vec3d& normal);
};

/// The prism around three points: their extent along the axes, with margins.
/// @param points  from `origin`
Prism prismAround(const std::array<Vec3d, 3>& points, const openvdb::Coord& origin,
                  const TriangleFrame& frame, const std::array<double, 3>& margins);

}  // namespace vox
