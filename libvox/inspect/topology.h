#pragma once

#include "libvox/grid/openvdb_fwd.h"

#include <memory>

namespace vox {

/// @throws InputError  always: the grid is of another type
[[noreturn]] void refuseType(const openvdb::GridBase& grid);

/// The active voxels of a grid of any type that can be compared (compared_types.h).
/// @throws InputError  another type
std::shared_ptr<openvdb::MaskTree> topologyOf(const openvdb::GridBase& grid);

}  // namespace vox
