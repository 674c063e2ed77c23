// Which of the options, an object and the scene has the say.

#include "libvox/pipeline/asked.h"

#include "libvox/core/error.h"
#include "libvox/options/voxelize.h"
#include "libvox/pipeline/choose.h"

#include <algorithm>
#include <string>

namespace vox {

StopRule stopRuleOf(const SceneObject& object, const Scene& scene, const ConvertOptions& options) {
  for (const auto& said : {options.until, object.until, scene.until})
    if (said) return *said;
  return {};
}

Voxelize voxelizeOf(const SceneObject& object, const Scene& scene, const ConvertOptions& options) {
  for (const auto& said : {options.voxelize, object.voxelize, scene.voxelize})
    if (said) return *said;
  return Voxelize::kAuto;
}

void requireStopRules(const Scene& scene, const ConvertOptions& options) {
  for (const SceneObject& object : scene.objects) {
    const std::string fault = faultOf(stopRuleOf(object, scene, options),
                                      voxelizeOf(object, scene, options), options.separation);
    if (!fault.empty()) throw UsageError(object.name + ": " + fault);
  }
}

std::vector<GridKind> gridsOf(const Scene& scene, const ConvertOptions& options) {
  std::vector<GridKind> kinds =
      options.grids.value_or(scene.grids.value_or(std::vector{GridKind::kDensity}));
  const bool colored = std::find(kinds.begin(), kinds.end(), GridKind::kColor) != kinds.end();
  if (!options.texture || colored) return kinds;
  if (options.grids) throw UsageError("--texture needs color among --grids");
  kinds.push_back(GridKind::kColor);
  return kinds;
}

}  // namespace vox
