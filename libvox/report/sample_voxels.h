#pragma once

#include "libvox/grid/openvdb.h"

#include <cstdint>
#include <vector>

namespace vox {

/// Active voxels of a tree, in its order: all of them, or every n-th so that there are at most
/// `most`.
std::vector<openvdb::Coord> sampleVoxels(const openvdb::MaskTree& voxels, std::uint64_t most);

}  // namespace vox
