#pragma once

#include "libvox/grid/openvdb_fwd.h"

#include <memory>

namespace vox {

/// A band of distances made wider: farther distances follow from those that are there by the fast
/// sweeping method (OpenVDB's dilateSdf). They are not exact: from 20 to 40 voxels the error was at
/// most 0.4 voxels (rms 0.09), from 20 to 100 voxels 0.9 (rms 0.34).
/// @param narrow  half width `from` voxels on both sides
/// @param to      half width of the result in voxels, at least `from`
/// @param voxelSize  world units
std::shared_ptr<openvdb::FloatTree> widened(const std::shared_ptr<openvdb::FloatTree>& narrow,
                                            double from, double to, double voxelSize);

}  // namespace vox
