#pragma once

#include "libvox/render/camera.h"
#include "libvox/report/difference_look.h"

#include <cstdint>
#include <string>

namespace vox {

/// Voxels as points for the viewer (viewer.js).
struct PointCloud {
  std::uint64_t differing = 0;  ///< points of voxels that differ
  std::uint64_t common = 0;     ///< points of voxels that do not
  std::uint64_t step = 1;       ///< of the voxels that differ, one in so many is a point
  openvdb::CoordBBox box;
  /// For each point its x, y and z as differences from the point before (the first: from the lowest
  /// corner of the box), zigzag and base 128 (Protocol Buffers' sint32), then a byte: what changed
  /// (VoxelChange) in its upper two bits, the difference of its value, 0 to 63, in the others.
  std::string bytes;
};

/// Voxels that differ, and some of the others around them.
/// @param most  of the voxels that differ
PointCloud pointsOf(const DifferenceLook& look, std::uint64_t most);

/// Some voxels, all as not different.
PointCloud pointsOf(const openvdb::MaskTree& voxels, std::uint64_t most);

/// The viewer as HTML: a canvas with its points and controls.
/// @param id       unique in the page
/// @param toWorld  linear
/// @param view     the first one
std::string viewerOf(const PointCloud& cloud, const openvdb::math::Transform& toWorld,
                     const View& view, const std::string& id);

}  // namespace vox
