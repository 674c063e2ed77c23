#pragma once

#include "libvox/mesh/stop_rule.h"
#include "libvox/subdivide/level.h"

#include <string>

namespace vox {

/// An object as it is voxelized, in index space.
struct PreparedSurface {
  std::string name;
  SubdivisionLevel base;
  StopRule until;
};

}  // namespace vox
