#pragma once

#include "libvox/grid/openvdb_fwd.h"
#include "libvox/pipeline/prepared_surface.h"

#include <vector>

namespace vox {

class Progress;

/// The faces of an object by what their components enclose; both ascending.
struct SolidAndSheets {
  std::vector<Index> solid;   ///< of components that are closed, or open but around something
  std::vector<Index> sheets;  ///< of the others
};

/// @param active  the voxels of the surface of all objects
/// @param solid   these, and what they enclose
/// @throws Cancelled
SolidAndSheets solidAndSheets(const PreparedSurface& surface, const openvdb::MaskTree& active,
                              const openvdb::MaskTree& solid, Progress& progress);

}  // namespace vox
