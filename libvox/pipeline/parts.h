#pragma once

#include "libvox/grid/openvdb_fwd.h"
#include "libvox/pipeline/prepared_surface.h"

#include <memory>
#include <span>
#include <string>

namespace vox {

class MemoryBudget;
class Progress;

/// Metadata of the grid `part`: partNamesText.
inline constexpr const char* kPartNamesMetadata = "vox_part_names";

/// The grid `part`: the number of the part of each voxel, Int32, background 0. An active voxel has
/// the part of the face at its foot: of the point of all surfaces that is closest to its middle.
/// Other voxels have the part of an active voxel near them (spreadLabels).
/// @param mask      the active voxels
/// @param voxels    those of the grid; null: those of the mask
/// @param surfaces  with PreparedSurface::partOfFace
/// @throws LimitError  the grid does not fit into the budget
/// @throws Cancelled
std::shared_ptr<openvdb::GridBase> makePartGrid(const openvdb::MaskGrid& mask,
                                                const openvdb::MaskTree* voxels,
                                                std::span<const PreparedSurface> surfaces,
                                                std::span<const std::string> names,
                                                MemoryBudget& budget, Progress& progress);

}  // namespace vox
