#pragma once

#include "libvox/grid/leaf_words.h"

#include <cstdint>
#include <vector>

namespace vox {

/// Number of sides of a cube of voxels. A side is named by 2 axis + (1 if it is the upper one).
inline constexpr int kSides = 6;

/// The voxels of a leaf on one of its sides, as 8 x 8 bits by their two other coordinates.
std::uint64_t sideOf(const LeafWords& leaf, int side);

/// Splits the voxels of a leaf that are not in `active` into sets that are connected through faces.
/// Appends the sets, ordered by their lowest voxels; at most 256.
void appendInactiveRegions(const LeafWords& active, std::vector<LeafWords>& regions);

/// A voxel deep inside a set of voxels of a leaf.
struct DeepVoxel {
  int depth;  ///< number of erosions that it survives
  int voxel;  ///< 64 x + 8 y + z
};
/// The lowest of the voxels that survive the most erosions of a set. Voxels outside the leaf count
/// as members of the set. Precondition: the set is not empty.
DeepVoxel deepestOf(const LeafWords& region);

}  // namespace vox
