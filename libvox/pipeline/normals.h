#pragma once

#include "libvox/grid/openvdb_fwd.h"
#include "libvox/pipeline/prepared_surface.h"

#include <memory>
#include <span>

namespace vox {

class MemoryBudget;
class Progress;

/// The grid `normal`: at each voxel the exact normal of the limit surface at the point closest to
/// the middle of the voxel; of objects that are not smoothed, the normal of the polygon there. Unit
/// vectors, outward; 0 where the surface has no normal. Source: paper section 8; DESIGN section 18.
/// @param voxels  of the grid, without tiles
/// @param reach   of feet (feet.h), voxels
/// @throws LimitError
/// @throws Cancelled
std::shared_ptr<openvdb::Vec3SGrid> makeNormalGrid(const openvdb::MaskGrid& voxels,
                                                   std::span<const PreparedSurface> surfaces,
                                                   float reach, MemoryBudget& budget,
                                                   Progress& progress);

}  // namespace vox
