#pragma once

#include "libvox/grid/openvdb.h"

namespace vox {

/// A grid to be given to an OpenVDB archive in place of `grid`. It shares the tree and is written
/// in the same bytes, but OpenVDB serializes and compresses its leaves on all threads, in groups of
/// up to some 13 MB. Only grids of floats and of float vectors are wrapped; others are returned
/// unchanged (masks have no values to compress).
openvdb::GridBase::ConstPtr writtenInParallel(const openvdb::GridBase::Ptr& grid);

}  // namespace vox
