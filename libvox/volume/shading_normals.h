#pragma once

#include "libvox/core/types.h"
#include "libvox/grid/openvdb.h"

#include <vector>

namespace vox {

/// Congradient shading: normals from nothing but voxels (paper section 9).
///
/// The surface around a voxel is a height field over the plane that it faces most: in each column
/// the outermost voxel of the sheet, which ends where the height leaps. Along both axes of the
/// plane it is differenced forward, backward and across three columns to each side, and across six,
/// as the slope of the plane that fits the columns there best; the four are weighted by how small
/// their misfit is. So a smooth surface is averaged over up to 13 x 13 columns, and an edge stays
/// sharp, since a difference that does not cross it fits better.
///
/// Not thread-safe; make one per task.
/// The idea of three differences is that of Cohen, Kaufman, Bakalash & Bergman 1990; height field,
/// fit and weights are ours. libvox/README.md says what they gain.
class CongradientNormals {
 public:
  /// @param voxels  must outlive this
  explicit CongradientNormals(const openvdb::MaskTree& voxels);

  /// Unit normal of the surface at an active voxel, in index space.
  /// @param face          outward unit normal of the side of the voxel that is seen
  /// @param towardViewer  where from, a unit vector: says which side of the surface is outside
  Vec3d at(const openvdb::Coord& voxel, const Vec3d& face, const Vec3d& towardViewer);

 private:
  /// What was asked for last among the voxels that share a slot: neighbouring rays hit the same.
  struct Known {
    openvdb::Coord voxel;
    int side = -1;  // of the voxel, where the surface was begun from
    Vec3d normal;
  };

  Vec3d estimate(const openvdb::Coord& voxel, int start, int sign);

  openvdb::tree::ValueAccessor<const openvdb::MaskTree> voxels_;
  std::vector<Known> known_;
};

}  // namespace vox
