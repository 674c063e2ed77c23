#pragma once

#include "libvox/foot/cell.h"
#include "libvox/foot/star_fit.h"

#include <cstdint>

namespace vox {

/// Adds a cell of the kind kHeight to a store.
/// @param patch       index space
/// @param reach       largest distance of interest, voxels
/// @param newtonStop  a shorter step of Newton's method is the last one, voxels
void addHeightCell(const HeightPatch& patch, float reach, float newtonStop, std::uint32_t owner,
                   CellStore& store);

}  // namespace vox
