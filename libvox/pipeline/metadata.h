#pragma once

#include "libvox/grid/openvdb_fwd.h"
#include "libvox/io/scene_file.h"
#include "libvox/pipeline/conversion_report.h"
#include "libvox/pipeline/request.h"

namespace vox {

/// Metadata of the grids of a conversion: version, input, options, levels, guarantee, number of
/// voxels. No time, no machine: equal input gives equal bytes.
openvdb::MetaMap describe(const Scene& scene, const Request& request, const ConvertReport& report);

}  // namespace vox
