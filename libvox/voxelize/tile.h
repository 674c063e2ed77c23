#pragma once

#include "libvox/mesh/patch.h"

#include <array>
#include <cstdint>

namespace vox {

// A tile is a regular patch that fits into a MarkBrick: N x N vertices, N = 2^k, within 4 leaves
// along each axis. Coordinates are a quadratic polynomial along each row. They are computed by
// forward differences in fixed point modulo 32 voxels, the size of a MarkBrick.
//
// Error: with 27 fractional bits, each start value of a row is off by at most e = 2^-28. The error
// of value j is at most e from the start value, j e from the first difference and j (j - 1) / 2 e
// from the second: for N <= 64 at most 2,017 e, 7.6e-6 voxels, for grids of any size. The doubles
// from which the start values are rounded are off by a few 2^-53 of the coordinate: 1e-11 voxels at
// coordinates of 16384.

/// Largest k of a tile.
inline constexpr int kMostTileLevels = 6;
/// Smallest k of a tile; for smaller patches it is cheaper to evaluate each vertex.
inline constexpr int kLeastTileLevels = 3;

/// Upper bound of the error of a coordinate, in voxels.
inline constexpr double kTileError = 1e-5;

/// The control points of a tile, coordinate by coordinate: [axis][u][v].
using TileControls = std::array<std::array<std::array<double, 3>, 3>, 3>;

/// The control points of a patch, moved by multiples of 32 voxels along each axis so that the
/// middle one is in 0 .. 32.
TileControls tileControls(const Patch& patch);

/// Marks the voxels of all N x N vertices of a tile in a MarkBrick; N = 2^k, kLeastTileLevels <= k
/// <= kMostTileLevels. The same bits on every processor, because products and sums of doubles have
/// a fixed order and only additions of integers follow.
void markTile(const TileControls& controls, int k, std::uint8_t* marks);

/// The arithmetic of markTile without the marks: the sum of all coordinates, modulo 2^32. For
/// benchmarks.
std::uint32_t sumTile(const TileControls& controls, int k);

}  // namespace vox
