#pragma once

#include "libvox/core/types.h"
#include "libvox/grid/openvdb.h"

#include <vector>

namespace vox {

/// Congradient shading: normals from voxels alone (paper section 9).
///
/// The surface around a voxel is taken as a height field over the axis plane that it faces most.
/// The height in a column is that of the outermost voxel of the sheet; the sheet ends where heights
/// jump. Along both axes of the plane there are four slopes: backward, forward and central over
/// three columns to each side, and central over six. Each is the slope of the plane that fits its
/// columns best. Their mean is weighted by how well these planes fit. So a smooth surface is
/// averaged over up to 13 x 13 columns, and an edge stays sharp, because differences that do not
/// cross it fit better.
///
/// Not thread-safe: one object per task.
/// Source: the three differences are those of Cohen, Kaufman, Bakalash & Bergman 1990. Height
/// field, fit and weights are our own; libvox/README.md has measurements.
class CongradientNormals {
 public:
  /// @param voxels  must outlive this object
  explicit CongradientNormals(const openvdb::MaskTree& voxels);

  /// Unit normal of the surface at an active voxel, in index space.
  /// @param face          outward unit normal of the visible side of the voxel
  /// @param towardViewer  unit vector to the viewer; decides which side of the surface is outside
  Vec3d at(const openvdb::Coord& voxel, const Vec3d& face, const Vec3d& towardViewer);

 private:
  /// The last result of a slot of the cache. (Neighbouring rays often hit the same voxel.)
  struct Known {
    openvdb::Coord voxel;
    int side = -1;  // visible side of the voxel, from which the estimate started
    Vec3d normal;
  };

  Vec3d estimate(const openvdb::Coord& voxel, int start, int sign);

  openvdb::tree::ValueAccessor<const openvdb::MaskTree> voxels_;
  std::vector<Known> known_;
};

}  // namespace vox
