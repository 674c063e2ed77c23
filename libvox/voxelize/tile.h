#pragma once

#include "libvox/mesh/patch.h"

#include <array>
#include <cstdint>

namespace vox {

// A tile is a regular patch that fits into a MarkBrick: N x N vertices, N = 2^k, within 4 leaves
// along each axis. Coordinates are a quadratic polynomial along each row, so they are stepped by
// forward differences in fixed point modulo 32 voxels, which is just what a MarkBrick counts in.
//
// Error: with 27 fractional bits, an end of a difference is off by at most e = 2^-28. Value j of a
// row starts off by e, its first differences add j e and its second ones j (j - 1) / 2 e: for N <=
// 64 at most 2,017 e, 7.6e-6 voxels, whatever the size of the grid. The doubles they start from are
// off by a few 2^-53 of the coordinate: 1e-11 voxels at coordinates of 16384.

/// Largest k of a tile whose rows are stepped.
inline constexpr int kMostTileLevels = 6;
/// Smallest one; below it is cheaper to evaluate each vertex.
inline constexpr int kLeastTileLevels = 3;

/// Upper bound on the distance of a stepped coordinate from the true one, in voxels.
inline constexpr double kTileError = 1e-5;

/// The control points of a tile, coordinate by coordinate: [axis][u][v].
using TileControls = std::array<std::array<std::array<double, 3>, 3>, 3>;

/// Controls of a patch, moved by multiples of 32 voxels to somewhere near 0.
TileControls tileControls(const Patch& patch);

/// Marks the voxels of all N x N vertices of a tile, N = 2^k with kLeastTileLevels <= k <=
/// kMostTileLevels, in the bytes of a MarkBrick. The same bits on every processor: additions of
/// integers, after products and sums of doubles in a fixed order.
void markTile(const TileControls& controls, int k, std::uint8_t* marks);

/// The same arithmetic without the marks: sum of all stepped coordinates, modulo 2^32. What
/// benchmarks compare the rest with.
std::uint32_t sumTile(const TileControls& controls, int k);

}  // namespace vox
