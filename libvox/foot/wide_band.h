#pragma once

#include "libvox/grid/openvdb_fwd.h"
#include "libvox/options/volume_options.h"

#include <memory>

namespace vox {

/// A band of distances made wider, inside, outside or both: farther distances follow from those
/// that are there by the fast sweeping method (OpenVDB's dilateSdf). They are not exact: from 20 to
/// 40 voxels the error was at most 0.4 voxels (rms 0.09), from 20 to 100 voxels 0.9 (rms 0.34). A
/// side that has its width already stays as it is.
/// @param narrow     is used up
/// @param from       widths of `narrow`
/// @param to         widths of the result, at least those of `from`
/// @param voxelSize  world units
std::shared_ptr<openvdb::FloatTree> widened(std::shared_ptr<openvdb::FloatTree> narrow,
                                            const BandWidths& from, const BandWidths& to,
                                            double voxelSize);

}  // namespace vox
