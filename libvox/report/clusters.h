#pragma once

#include "libvox/grid/openvdb.h"

#include <cstdint>
#include <vector>

namespace vox {

/// Voxels that touch each other through faces, edges or corners.
struct Cluster {
  std::uint64_t voxels = 0;
  openvdb::Coord first;  ///< lowest x, then y, then z
};

/// The largest clusters, largest first. None if the voxels are too many to look for them
/// (activeComponents).
std::vector<Cluster> largestClusters(const openvdb::MaskTree& voxels, std::size_t most);

/// Part of the cluster of a voxel that a close-up shows: all of it, or if it is longer than `side`,
/// a cube with that side about a voxel near its middle.
openvdb::CoordBBox closeUpBox(const openvdb::MaskTree& voxels, const openvdb::Coord& first,
                              int side);

}  // namespace vox
