#pragma once

#include "libvox/voxelize/scan.h"

#include <array>
#include <vector>

/// Scan conversion once more, slow and obvious.
namespace vox::test {

using Corners = std::array<Vec3d, 3>;
using Voxel = std::array<int, 3>;

/// Active voxels of a triangle, sorted, by Separation. Tries each of the 13 axes that may separate
/// a triangle and a box by projecting all their corners; halves the box of voxels as long as it
/// meets. |coordinate| up to 2^12 voxels.
std::array<std::vector<Voxel>, 2> naiveScan(const Corners& corners);

/// Whether a triangle (snapped) meets the closed box of a voxel with sides of `widths` (0 or 1):
/// clips it at the six sides, in rational numbers.
bool clipMeets(const Corners& corners, const Voxel& voxel, const std::array<int, 3>& widths);

/// Boxes of which an active voxel must meet one.
std::vector<std::array<int, 3>> targetWidths(Separation separation);

}  // namespace vox::test
