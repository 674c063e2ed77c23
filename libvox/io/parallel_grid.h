#pragma once

#include "libvox/grid/openvdb_fwd.h"

#include <memory>

namespace vox {

/// A grid to be given to an OpenVDB archive in place of `grid`. It shares the tree and is written
/// in the same bytes, but its nodes and leaves are serialized and compressed on all threads, in
/// parts of 256 to 512 KiB, two for each thread. Its statistics are computed on all threads, too.
/// Grids of masks, floats, float vectors and labels are wrapped; others are returned unchanged.
std::shared_ptr<const openvdb::GridBase> writtenInParallel(
    const std::shared_ptr<openvdb::GridBase>& grid);

}  // namespace vox
