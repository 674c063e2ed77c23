#pragma once

#include "libvox/grid/openvdb_fwd.h"
#include "libvox/grid/region.h"
#include "libvox/options/grid_kind.h"
#include "libvox/options/volume_options.h"
#include "libvox/pipeline/distance.h"
#include "libvox/pipeline/prepared_surface.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace vox {

class MemoryBudget;
class Progress;

/// Bytes of the nodes of a mask, if each voxel has a float, or a vector.
std::uint64_t bytesOfFloats(const openvdb::MaskTree& mask);
std::uint64_t bytesOfVectors(const openvdb::MaskTree& mask);

/// Advice for a grid that is too large.
inline constexpr const char* kScatteredAdvice =
    "the model is scattered over much space: use larger voxels, or raise --max-memory";

/// True if one of the grids is made from the active voxels.
bool needsVoxels(std::span<const GridKind> kinds);
/// True if one of the grids is made from more than the active voxels.
bool needsSurfaces(std::span<const GridKind> kinds, const VolumeSettings& volume);
/// True if one of the grids tells inside from outside.
bool needsInside(std::span<const GridKind> kinds, const VolumeSettings& volume);

/// What grids are made of.
struct GridSources {
  std::shared_ptr<openvdb::MaskGrid> mask = nullptr;  ///< active voxels; empty unless needed
  std::span<const PreparedSurface> surfaces = {};
  MarkVoxels markVoxels = {};  ///< makes the active voxels of all surfaces if the mask is empty
  /// The voxels of a soft density near the surface (soft_density.h); null if there is none.
  std::shared_ptr<openvdb::MaskGrid> soft = nullptr;
  /// A density that holds the inside, of which the grid `part` tells the parts; null if it does
  /// not.
  std::shared_ptr<openvdb::FloatGrid> solid = nullptr;
  std::size_t partCount = 0;
  Region region = {};      ///< other voxels need no values, but grids may have some
  Region bandOfPart = {};  ///< if it has pages: of a level set only they are made, if possible
};

/// The output grid of a kind.
/// @param warnings  gets lines for the report
/// @throws LimitError  the grid does not fit into the budget
/// @throws Cancelled
std::shared_ptr<openvdb::GridBase> makeGrid(GridKind kind, const GridSources& sources,
                                            const VolumeSettings& volume, MemoryBudget& budget,
                                            Progress& progress, std::vector<std::string>& warnings);

/// Bytes of a file of these grids, as once measured.
std::uint64_t expectedBytes(std::span<const std::shared_ptr<openvdb::GridBase>> grids);

}  // namespace vox
