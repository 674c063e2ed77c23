#pragma once

#include "libvox/options/grid_kind.h"
#include "libvox/options/stop_rule.h"
#include "libvox/pipeline/convert.h"

#include <vector>

namespace vox {

// What is asked for: what the options say, else the object, else the scene, else the default.

StopRule stopRuleOf(const SceneObject& object, const Scene& scene, const ConvertOptions& options);

Voxelize voxelizeOf(const SceneObject& object, const Scene& scene, const ConvertOptions& options);

/// Checks both together, for every object.
/// @throws UsageError  their combination is none (choose.h)
void requireStopRules(const Scene& scene, const ConvertOptions& options);

/// The grids, in the order asked for.
/// @throws UsageError  a texture is asked for, but not the color grid
std::vector<GridKind> gridsOf(const Scene& scene, const ConvertOptions& options);

}  // namespace vox
