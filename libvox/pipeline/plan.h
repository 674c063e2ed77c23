#pragma once

#include "libvox/core/progress.h"
#include "libvox/grid/transform.h"
#include "libvox/options/grid_kind.h"
#include "libvox/pipeline/convert.h"

#include <span>
#include <vector>

namespace vox {

/// Area of each object's control mesh, in square voxels: what the work of the later stages follows.
/// Zeros when nobody watches.
std::vector<double> areasOf(const Scene& scene, const GridTransform& transform,
                            const Progress& progress);

/// Announces all stages of a conversion, writing included.
void plan(const Scene& scene, const ConvertOptions& options, std::span<const double> areas,
          std::span<const GridKind> kinds, Progress& progress);

}  // namespace vox
