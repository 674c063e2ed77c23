#pragma once

#include "libvox/core/memory.h"
#include "libvox/grid/region.h"
#include "libvox/grid/transform.h"
#include "libvox/io/scene_file.h"
#include "libvox/pipeline/conversion_report.h"
#include "libvox/pipeline/estimate.h"
#include "libvox/pipeline/prepared_surface.h"
#include "libvox/pipeline/request.h"

#include <string>
#include <vector>

namespace vox {

class Progress;

/// A scene that is ready to voxelize.
struct PreparedScene {
  MemoryBudget budget;
  GridTransform transform = {};
  Region region = {};                          ///< the voxels asked for
  std::vector<double> areas = {};              ///< areasOf
  std::vector<PreparedSurface> surfaces = {};  ///< one for each object, in index space
  std::vector<std::string> partNames = {};     ///< if the request has parts (parts.h)
  Estimate estimate = {};                      ///< without levels; may hold a refusal
};

/// Prepares every object, estimates the grids, and announces the work of all stages. Reports voxel
/// size, threads, warnings and what preparation did to each object.
/// @param usedUp  the scene itself, of whose meshes only the attributes are needed any more; null:
///   they stay
/// @throws as convert, except that grids which do not fit are no error: see Estimate::refusal
PreparedScene prepareScene(const Scene& scene, const Request& request, Progress& progress,
                           ConvertReport& report, Scene* usedUp = nullptr);

}  // namespace vox
