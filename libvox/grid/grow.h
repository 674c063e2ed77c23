#pragma once

#include "libvox/grid/openvdb.h"

#include <openvdb/tools/Morphology.h>

namespace vox {

/// Switches on the 26 neighbours of all active voxels. Full leaves stay leaves.
/// @param voxels  without tiles
inline void grow(openvdb::MaskTree& voxels) {
  openvdb::tools::dilateActiveValues(voxels, 1, openvdb::tools::NN_FACE_EDGE_VERTEX,
                                     openvdb::tools::IGNORE_TILES);
}

}  // namespace vox
