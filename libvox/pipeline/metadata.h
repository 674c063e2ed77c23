#pragma once

#include "libvox/grid/openvdb_fwd.h"
#include "libvox/grid/transform.h"
#include "libvox/io/scene_file.h"
#include "libvox/options/convert_options.h"
#include "libvox/pipeline/conversion_report.h"

namespace vox {

/// Metadata of the grids of a conversion: version, input, options, levels, guarantee, number of
/// voxels. No time, no machine: equal input gives equal bytes.
openvdb::MetaMap describe(const Scene& scene, const ConvertOptions& options,
                          const GridTransform& transform, const ConvertReport& report);

}  // namespace vox
