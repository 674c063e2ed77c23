#pragma once

#include "libvox/options/component_limit.h"
#include "libvox/options/smoothing_options.h"

#include <optional>

namespace vox {

/// How meshes are made ready to subdivide. A value that is not set comes from the object, else from
/// the scene, else from the default.
struct PreparationOptions {
  SmoothingOptions smoothing;           ///< default: boundary extended, nothing interpolated
  std::optional<double> weldTolerance;  ///< world units; default 0: equal positions only
  std::optional<ComponentLimit> dropComponents;  ///< default: no component is dropped
  /// true: a mesh that needs repair, or whose file is odd (read_report.h), is refused; default
  /// false
  std::optional<bool> strict;
};

}  // namespace vox
