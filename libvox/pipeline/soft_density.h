#pragma once

#include "libvox/grid/openvdb_fwd.h"
#include "libvox/options/volume_options.h"
#include "libvox/pipeline/prepared_surface.h"

#include <memory>
#include <span>

namespace vox {

class MemoryBudget;
class Progress;

/// The grid `density` with soft edges: `value` times the part of each voxel's cube that is inside
/// (Fill::kSolid), or within half a voxel of a surface (Fill::kSurface, and sheets of kSolid). This
/// part is that of the plane through the point of the surface closest to the voxel's centre. Voxels
/// with the part 0 are inactive. What is inside is decided as in solidOf (inside.h), but within
/// half a voxel of the surface by the side of the closest point.
/// @param mask  active voxels of all surfaces, without tiles
/// @param warnings  as for solidOf
/// @throws LimitError
/// @throws Cancelled
std::shared_ptr<openvdb::FloatGrid> softDensityGrid(const openvdb::MaskTree& mask,
                                                    std::span<const PreparedSurface> surfaces,
                                                    const VolumeSettings& settings, float value,
                                                    MemoryBudget& budget, Progress& progress,
                                                    std::vector<std::string>& warnings);

/// Name of the metadata, of a soft density and of its file, that tells that it is "soft".
inline constexpr const char* kEdgeMetadata = "vox_edge";

/// The active voxels of a soft density that are at most one voxel from those of the mask: all of
/// them, but for those deeper in a solid. Without tiles, with the transform of the mask.
std::shared_ptr<openvdb::MaskGrid> softVoxels(const openvdb::FloatGrid& density,
                                              const openvdb::MaskGrid& mask);

}  // namespace vox
