#pragma once

#include "libvox/grid/openvdb_fwd.h"

#include <memory>

namespace vox {

/// A grid to be given to an OpenVDB archive in place of `grid`. It shares the tree and is written
/// in the same bytes, but OpenVDB serializes and compresses its leaves on all threads, in groups of
/// up to some 13 MB. Only grids of floats, float vectors and labels are wrapped; others are
/// returned unchanged (masks have no values to compress).
std::shared_ptr<const openvdb::GridBase> writtenInParallel(
    const std::shared_ptr<openvdb::GridBase>& grid);

}  // namespace vox
