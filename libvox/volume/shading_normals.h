#pragma once

#include "libvox/core/types.h"

#include <openvdb/openvdb.h>

namespace vox {

/// Congradient shading: normals from nothing but voxels (paper section 9).
///
/// The surface around a voxel is a height field over the plane that it faces most: in each column
/// up to three voxels away, the outermost voxel of the sheet, which ends where the height leaps.
/// Along both axes of the plane it is differenced forward, backward and across, as the slope of the
/// plane that fits the columns there best; the three are weighted by how small their misfit is. So
/// a smooth surface is averaged over 7 x 7 columns, and an edge stays sharp, since a difference
/// that does not cross it fits better.
///
/// Not thread-safe; make one per task.
/// The idea of three differences is that of Cohen, Kaufman, Bakalash & Bergman 1990; height field,
/// fit and weights are ours. libvox/README.md says what they gain.
class CongradientNormals {
 public:
  /// @param voxels  must outlive this
  explicit CongradientNormals(const openvdb::MaskTree& voxels) : voxels_(voxels) {}

  /// Unit normal of the surface at an active voxel, in index space, on the side it is seen from.
  /// @param towardViewer  where from, not zero; a face of the voxel on that side should be free
  Vec3d at(const openvdb::Coord& voxel, const Vec3d& towardViewer);

 private:
  openvdb::tree::ValueAccessor<const openvdb::MaskTree> voxels_;
};

}  // namespace vox
