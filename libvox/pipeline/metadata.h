#pragma once

#include "libvox/grid/openvdb.h"
#include "libvox/grid/transform.h"
#include "libvox/pipeline/convert.h"

namespace vox {

/// Metadata of the grids of a conversion: version, input, options, levels, guarantee, voxel count.
/// No time, no machine: equal input gives equal bytes.
openvdb::MetaMap describe(const Scene& scene, const ConvertOptions& options,
                          const GridTransform& transform, const ConvertReport& report);

}  // namespace vox
