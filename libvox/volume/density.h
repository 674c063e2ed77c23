#pragma once

#include <openvdb/openvdb.h>

namespace vox {

/// Fog volume `density`: 1 at the voxels of the mask, background 0, the mask's transform.
openvdb::FloatGrid::Ptr densityGrid(const openvdb::MaskGrid& mask);

}  // namespace vox
