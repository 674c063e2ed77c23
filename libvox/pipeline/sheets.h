#pragma once

#include "libvox/grid/openvdb_fwd.h"
#include "libvox/pipeline/components.h"
#include "libvox/pipeline/prepared_surface.h"

#include <vector>

namespace vox {

class Progress;

/// The components of an object.
struct BodiesAndSheets {
  std::vector<MeshComponent> bodies;  ///< closed ones, and open ones that enclose something
  std::vector<Index> sheets;          ///< faces of the others, ascending
};

/// @param active  the voxels of the surface of all objects
/// @param solid   these, and what they enclose
/// @throws Cancelled
BodiesAndSheets bodiesAndSheets(const PreparedSurface& surface, const openvdb::MaskTree& active,
                                const openvdb::MaskTree& solid, Progress& progress);

}  // namespace vox
