#pragma once

#include "libvox/grid/openvdb.h"

#include <cstddef>
#include <vector>

namespace vox {

/// One tree of values for each label, which together hold the active voxels of a density. Parallel
/// over leaves; a leaf is looked at once for all its labels.
/// @param labels  from 1 to `count` at every active voxel of the density
/// @return        null where a label has no voxels
std::vector<openvdb::FloatTree::Ptr> splitDensity(const openvdb::FloatTree& density,
                                                  const openvdb::Int32Tree& labels,
                                                  std::size_t count);

/// Bytes of what splitDensity returns, at most.
std::uint64_t bytesOfSplitting(const openvdb::FloatTree& density, const openvdb::Int32Tree& labels,
                               std::size_t count);

}  // namespace vox
