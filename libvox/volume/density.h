#pragma once

#include <openvdb/openvdb.h>

namespace vox {

/// Fog volume `density`: `value` at the voxels and tiles of the mask, background 0.
openvdb::FloatGrid::Ptr densityGrid(const openvdb::MaskTree& mask, float value = 1);

}  // namespace vox
