#pragma once

#include "libvox/grid/voxel.h"
#include "libvox/mesh/patch.h"

#include <array>

namespace vox {

/// A box of all voxels that can hold descendants of a patch. It is the box of the Bezier points of
/// the patch: subdivision only cuts corners, so all descendants stay in it.
struct VoxelBox {
  openvdb::Coord low, high;

  /// @param patch   with all four faces
  /// @param margin  bound of the error of computed descendants, in voxels
  VoxelBox(const Patch& patch, double margin) {
    const auto bezier = [](const Vec3d& a, const Vec3d& b, const Vec3d& c) {
      return std::array<Vec3d, 3>{(a + b) / 2.0, b, (b + c) / 2.0};
    };
    std::array<std::array<Vec3d, 3>, 3> rows;
    for (std::size_t u = 0; u < 3; ++u)
      rows[u] = bezier(patch.points[u][0], patch.points[u][1], patch.points[u][2]);
    Vec3d least = rows[1][1];
    Vec3d most = rows[1][1];
    for (std::size_t v = 0; v < 3; ++v)
      for (const Vec3d& point : bezier(rows[0][v], rows[1][v], rows[2][v])) {
        least = least.cwiseMin(point);
        most = most.cwiseMax(point);
      }
    low = voxelOf(least - Vec3d::Constant(margin));
    high = voxelOf(most + Vec3d::Constant(margin));
  }
};

}  // namespace vox
