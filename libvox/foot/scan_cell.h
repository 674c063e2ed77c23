#pragma once

#include "libvox/foot/foot_brick.h"
#include "libvox/foot/prism_rows.h"

#include <array>
#include <cstddef>
#include <cstdint>

namespace vox {

/// Index of the leaf of a voxel in its bin, and of the voxel in its leaf.
inline unsigned leafOf(unsigned x, unsigned y, unsigned z) {
  return (x >> 3) << 4 | (y >> 3) << 2 | z >> 3;
}
inline unsigned voxelInLeaf(unsigned x, unsigned y, unsigned z) {
  return (x & 7U) << 6 | (y & 7U) << 3 | (z & 7U);
}

/// Some voxels near a cell, relative to the lowest voxel of a bin, and their feet.
struct Feet {
  static constexpr std::size_t kMost = 1024;
  static constexpr std::size_t kSlack = 8;  ///< vectors are stored whole
  template <class Number>
  using Column = std::array<Number, kMost + kSlack>;
  alignas(64) Column<float> x;
  alignas(64) Column<float> y;
  alignas(64) Column<float> z;
  alignas(64) Column<std::uint32_t> voxel;  ///< leafOf << 9 | voxelInLeaf
  alignas(64) Column<float> t;              ///< distance, negative inside
  alignas(64) Column<float> a;
  alignas(64) Column<float> b;
  std::size_t count = 0;

  unsigned leaf(std::size_t i) const { return voxel[i] >> 9; }
  unsigned voxelOfLeaf(std::size_t i) const { return voxel[i] & 511U; }
};

/// Finds the feet of the voxels within the cell: a, b in -1 .. 1, and t, the distance to the
/// surface there. The same bits on every processor, and for voxels in any order.
void solveFeet(const NewtonCell& cell, const openvdb::Coord& binOrigin, Feet& feet);
/// The same for a height: a, b in voxels.
void solveFeet(const HeightCell& cell, const openvdb::Coord& binOrigin, Feet& feet);
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

/// Where a walk over the rows of a prism goes on: at row y of slice x.
struct RowsPlace {
  int x, y;
};

/// Adds voxels of a prism to `feet`, as many as there is place for, from `at` on.
/// @return whether these were the last ones
bool gatherVoxels(const PrismRows& rows, RowsPlace& at, Feet& feet);

/// Takes voxels out that are not wanted.
void keepWanted(const BinMask& wanted, Feet& feet);

/// Calls visit(feet) with the feet of all voxels of a bin in the prism of a cell, some at a time.
/// @param wanted  if not null, only these voxels
template <class Cell, class Visit>
void scanFeet(const Cell& cell, const openvdb::Coord& binOrigin, const BinMask* wanted, Feet& feet,
              Visit&& visit) {
  const PrismRows rows(cell.prism, binOrigin);
  if (rows.empty()) return;
  RowsPlace at = {rows.low[0], rows.low[1]};
  for (bool done = false; !done;) {
    feet.count = 0;
    done = gatherVoxels(rows, at, feet);
    if (wanted != nullptr) keepWanted(*wanted, feet);
    if (feet.count == 0) continue;
    solveFeet(cell, binOrigin, feet);
    visit(feet);
  }
}

}  // namespace vox
