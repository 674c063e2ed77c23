#pragma once

#include "libvox/grid/openvdb.h"

#include <memory>
#include <span>

namespace vox {

/// The voxels of a density that was split into a grid for each part (kPartNameMetadata): those of
/// all parts with the transform of the first, and its metadata. Null if there are no such grids.
std::shared_ptr<openvdb::MaskGrid> joinedParts(std::span<const openvdb::GridBase::Ptr> grids);

}  // namespace vox
