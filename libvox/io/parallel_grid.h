#pragma once

#include "libvox/grid/openvdb_fwd.h"

#include <memory>

namespace vox {

/// A view of a grid, with the same tree, for archives to write: its leaves are serialized and
/// compressed by OpenVDB on all threads, up to some 13 MB at a time, and come out in the same bytes
/// as from the grid itself. Other grids than those of floats and vectors are returned as they are:
/// of masks there is nothing to compress.
std::shared_ptr<const openvdb::GridBase> writtenInParallel(
    const std::shared_ptr<openvdb::GridBase>& grid);

}  // namespace vox
