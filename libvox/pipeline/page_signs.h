#pragma once

#include "libvox/grid/openvdb_fwd.h"
#include "libvox/grid/region.h"

#include <functional>
#include <span>
#include <vector>

namespace vox {

/// Tells of some voxels whether they are inside, 1 or 0 each.
using AreInside = std::function<std::vector<char>(std::span<const openvdb::Coord>)>;

/// Gives the pages of a region that have no leaf of a band, but lie inside, the inner background.
/// (For bands of some pages, because OpenVDB's flood needs all.)
/// @param box        voxels: others are outside
/// @param inside     background, world units, negative
/// @param areInside  asked for one voxel of each group of such pages that touch
void setInnerPages(openvdb::FloatTree& band, const Region& region, const openvdb::CoordBBox& box,
                   float inside, const AreInside& areInside);

}  // namespace vox
