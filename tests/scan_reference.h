#pragma once

#include "libvox/voxelize/scan.h"

#include <array>
#include <vector>

/// A slow but obvious scan conversion, with which tests compare that of the library.
namespace vox::test {

using Corners = std::array<Vec3d, 3>;
using Voxel = std::array<int, 3>;

/// Sorted active voxels of a triangle, indexed by Separation. Halves a box of voxels as long as it
/// meets the triangle; tests each of the 13 axes that may separate a triangle and a box by
/// projecting all corners. |coordinate| up to 2^12 voxels.
std::array<std::vector<Voxel>, 2> naiveScan(const Corners& corners);

/// Whether a triangle (snapped) meets the closed box of a voxel with sides of `widths` (0 or 1):
/// clips it at the six sides, in rational numbers.
bool clipMeets(const Corners& corners, const Voxel& voxel, const std::array<int, 3>& widths);

/// Widths of the boxes around the centre of a voxel. The voxel is active iff a triangle meets one
/// of them.
std::vector<std::array<int, 3>> targetWidths(Separation separation);

}  // namespace vox::test
