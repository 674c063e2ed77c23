#pragma once

#include "libvox/foot/foot_brick.h"
#include "libvox/foot/prism_rows.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace vox {

/// Some voxels near a cell, relative to the lowest voxel of a bin, and their feet.
struct Feet {
  static constexpr std::size_t kMost = 512;
  using Column = std::array<float, kMost + kBinSide>;
  alignas(64) Column x;
  alignas(64) Column y;
  alignas(64) Column z;
  alignas(64) Column t;  ///< distance, negative inside
  alignas(64) Column a;
  alignas(64) Column b;
  std::size_t count = 0;
};

/// Finds the feet of the voxels within the cell: a, b in -1 .. 1, and t, the distance to the
/// surface there. The same bits on every processor, and for voxels in any order.
void solveFeet(const NewtonCell& cell, const openvdb::Coord& binOrigin, Feet& feet);
/// The same for a triangle: a, b are the weights of its second and third point.
void solveFeet(const TriangleCell& cell, const openvdb::Coord& binOrigin, Feet& feet);

/// A key for each voxel of a bin, in the order of FootBrick.
using VoxelFloors = std::array<std::array<std::uint32_t, FootBrick::kVoxels>, FootBrick::kLeaves>;

/// Evaluates the polynomials of a cell at the voxels of a bin; keeps the least keys.
/// @param unsignedDistance  whether distances have no sign
/// @param floors            if not null, smaller keys do not count
void scanPolynomials(const PolynomialCell& cell, const openvdb::Coord& binOrigin,
                     bool unsignedDistance, const VoxelFloors* floors, FootBrick& brick);

/// Bits of the voxels of each leaf of a bin: bit y << 3 | z of word x.
using BinMask = std::array<std::array<std::uint64_t, 8>, FootBrick::kLeaves>;

/// Index of the leaf of a voxel in its bin, and of the voxel in its leaf.
inline unsigned leafOf(unsigned x, unsigned y, unsigned z) {
  return (x >> 3) << 4 | (y >> 3) << 2 | z >> 3;
}
inline unsigned voxelInLeaf(unsigned x, unsigned y, unsigned z) {
  return (x & 7U) << 6 | (y & 7U) << 3 | (z & 7U);
}

/// Calls visit(feet) with the feet of all voxels of a bin in the prism of a cell, some at a time.
/// @param wanted  if not null, only these voxels
template <class Cell, class Visit>
void scanFeet(const Cell& cell, const openvdb::Coord& binOrigin, const BinMask* wanted, Feet& feet,
              Visit&& visit) {
  const PrismRows rows(cell.prism, binOrigin);
  if (rows.empty()) return;
  const auto flush = [&] {
    if (feet.count == 0) return;
    solveFeet(cell, binOrigin, feet);
    visit(feet);
    feet.count = 0;
  };
  const auto add = [&](int x, int y, int z) {
    feet.x[feet.count] = static_cast<float>(x);
    feet.y[feet.count] = static_cast<float>(y);
    feet.z[feet.count] = static_cast<float>(z);
    ++feet.count;
  };
  PrismRows::Group first, last;
  for (int x = rows.low[0]; x <= rows.high[0]; ++x)
    for (int y8 = rows.low[1] & ~7; y8 <= rows.high[1]; y8 += PrismRows::kGroup) {
      rows.rowsAt(x, y8, first, last);
      for (int r = 0; r < PrismRows::kGroup; ++r) {
        const int z0 = static_cast<int>(first[static_cast<std::size_t>(r)]);
        const int z1 = static_cast<int>(last[static_cast<std::size_t>(r)]);
        if (z0 > z1) continue;
        if (feet.count + kBinSide > Feet::kMost) flush();
        const int y = y8 + r;
        for (int z = z0; z <= z1; ++z) {
          if (wanted != nullptr) {
            const auto ux = static_cast<unsigned>(x), uy = static_cast<unsigned>(y),
                       uz = static_cast<unsigned>(z);
            if (((*wanted)[leafOf(ux, uy, uz)][ux & 7U] >> ((uy & 7U) << 3 | (uz & 7U)) & 1U) == 0)
              continue;
          }
          add(x, y, z);
        }
      }
    }
  flush();
}

}  // namespace vox
