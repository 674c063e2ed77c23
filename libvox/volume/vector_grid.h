#pragma once

#include "libvox/grid/openvdb_fwd.h"

#include <memory>

namespace vox {

/// A grid of vectors with the nodes and active voxels of a mask, and its transform. Parallel.
/// @param mask   without tiles
/// @param value  of all active voxels; the background is 0
std::shared_ptr<openvdb::Vec3SGrid> vectorGrid(const openvdb::MaskGrid& mask, float value);

}  // namespace vox
