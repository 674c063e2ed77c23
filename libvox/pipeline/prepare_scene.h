#pragma once

#include "libvox/core/memory.h"
#include "libvox/core/progress.h"
#include "libvox/grid/transform.h"
#include "libvox/options/grid_kind.h"
#include "libvox/options/volume_options.h"
#include "libvox/pipeline/convert.h"
#include "libvox/pipeline/estimate.h"
#include "libvox/pipeline/grids.h"

#include <vector>

namespace vox {

/// Everything that a conversion begins with.
struct Preparation {
  MemoryBudget budget;
  std::vector<GridKind> kinds;
  VolumeOptions volume;
  GridTransform transform = {};
  std::vector<double> areas = {};              ///< areasOf
  std::vector<PreparedSurface> surfaces = {};  ///< one per object, their ways only about
  Estimate estimate = {};                      ///< without levels; may hold a refusal
};

/// Prepares every object in index space, and announces the work of all stages.
/// @throws as convert, except that grids which do not fit are no error: see Estimate::refusal
Preparation prepareScene(const Scene& scene, const ConvertOptions& options, Progress& progress,
                         ConvertReport& report);

}  // namespace vox
