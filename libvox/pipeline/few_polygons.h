#pragma once

#include "libvox/subdivide/level.h"

#include <optional>

namespace vox {

/// Some thousands of polygons near the smooth surface, for estimates. If `levels` is set: of that
/// level, or of an earlier one. None if the mesh itself has as many.
std::optional<PolygonMesh> fewPolygons(const SubdivisionLevel& base, std::optional<int> levels);

}  // namespace vox
