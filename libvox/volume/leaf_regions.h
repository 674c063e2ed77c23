#pragma once

#include "libvox/grid/merge_leaf.h"

#include <cstdint>
#include <vector>

namespace vox {

/// The six faces of a cube of voxels: 2 axis + (1 if it is the upper one).
inline constexpr int kSides = 6;

/// Voxels of a leaf on one of its sides, as bits of their two other coordinates.
std::uint64_t sideOf(const LeafWords& leaf, int side);

/// Cuts the voxels of a leaf that are not in `active` into sets that are connected through faces,
/// ordered by their lowest voxels. Appends them: at most 256.
void appendInactiveRegions(const LeafWords& active, std::vector<LeafWords>& regions);

/// A voxel of a set (not empty) that is deep inside: the lowest of those that are left when the set
/// has been eroded as often as it can, as bit number 64 x + 8 y + z. What lies outside the leaf
/// erodes nothing.
struct DeepVoxel {
  int depth;  ///< erosions it survives
  int voxel;
};
DeepVoxel deepestOf(const LeafWords& region);

}  // namespace vox
