#pragma once

#include "libvox/options/smoothing_options.h"

#include <optional>

namespace vox {

/// How meshes are made ready to subdivide. What is not set here is taken from the scene, then from
/// the default.
struct PreparationOptions {
  SmoothingOptions smoothing;           ///< default: boundary extended, nothing interpolated
  std::optional<double> weldTolerance;  ///< world units; default 0: equal positions only
  std::optional<bool> strict;  ///< whether a mesh that needs repair is refused; default false
};

}  // namespace vox
