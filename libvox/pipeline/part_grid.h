#pragma once

#include "libvox/grid/openvdb.h"
#include "libvox/pipeline/prepared_surface.h"

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace vox {

class MemoryBudget;
class Progress;

/// The grid `part`: the number of the part that each voxel belongs to. Background 0, transform of
/// the voxels.
///
/// A voxel near the surface has the part of the closest point of all surfaces together; one for
/// which no point was found, part 1. Deeper voxels have the part of the nearest surface voxel of
/// their solid (volume/spread_labels.h).
///
/// @param near      the voxels near the surface: those of the mask, or softVoxels
/// @param reach     how far their feet are first looked for, in voxels
/// @param solid     a density that holds more voxels; null: only those near the surface
/// @param surfaces  with the parts of their faces
/// @param count     number of parts
/// @throws LimitError  the grid does not fit into the budget
/// @throws Cancelled
std::shared_ptr<openvdb::Int32Grid> makePartGrid(const openvdb::MaskGrid& near, float reach,
                                                 const openvdb::FloatTree* solid,
                                                 std::span<const PreparedSurface> surfaces,
                                                 std::size_t count, MemoryBudget& budget,
                                                 Progress& progress);

/// One grid for each part of a density that has voxels, with the transform and the metadata of the
/// density and the name of its part as metadata. Together they are the density.
/// @param parts     the part of each of its voxels
/// @param names     of parts
/// @param warnings  one line if there are parts without voxels
/// @throws LimitError  the grids do not fit into the budget
std::vector<std::shared_ptr<openvdb::FloatGrid>> splitByParts(const openvdb::FloatGrid& density,
                                                              const openvdb::Int32Tree& parts,
                                                              const std::vector<std::string>& names,
                                                              MemoryBudget& budget,
                                                              std::vector<std::string>& warnings);

}  // namespace vox
