#pragma once

#include "libvox/grid/transform.h"
#include "libvox/io/scene_file.h"
#include "libvox/pipeline/request.h"

#include <span>
#include <vector>

namespace vox {

class Progress;

/// Area of each object's control mesh, in square voxels: the work of the later stages grows with
/// it. Zeros if the progress has no callback.
std::vector<double> areasOf(const Scene& scene, const GridTransform& transform,
                            const Progress& progress);

/// Announces all stages of a conversion, writing included.
/// @param areas  areasOf
void plan(const Scene& scene, const Request& request, std::span<const double> areas,
          Progress& progress);

}  // namespace vox
