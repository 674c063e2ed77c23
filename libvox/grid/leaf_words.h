#pragma once

#include <array>
#include <cstdint>

namespace vox {

/// The voxels of a leaf, one bit each, in OpenVDB's order: word x, bit 8 y + z.
using LeafWords = std::array<std::uint64_t, 8>;

/// The active voxels of a leaf of any tree.
template <class Leaf>
LeafWords activeWords(const Leaf& leaf) {
  LeafWords words;
  for (unsigned x = 0; x < words.size(); ++x)
    words[x] = leaf.getValueMask().template getWord<std::uint64_t>(x);
  return words;
}

/// The voxels that are not in a set.
inline LeafWords complementOf(const LeafWords& voxels) {
  LeafWords others;
  for (std::size_t x = 0; x < others.size(); ++x) others[x] = ~voxels[x];
  return others;
}

/// Number of voxels in a set.
std::uint64_t countOf(const LeafWords& voxels);

/// Least box around a set: coordinates within the leaf, 0 .. 7.
struct LeafBox {
  std::array<int, 3> low;
  std::array<int, 3> high;
};
/// Precondition: the set is not empty.
LeafBox boxOf(const LeafWords& voxels);

/// The number 64 x + 8 y + z of the lowest voxel of a set. Precondition: it is not empty.
int lowestVoxel(const LeafWords& voxels);

/// The voxels of a leaf that have a face in common with a voxel of a set.
LeafWords neighboursOf(const LeafWords& voxels);

/// The voxels of a set, and those of the leaf that have a face, edge or corner in common with one.
LeafWords allNeighboursOf(const LeafWords& voxels);

/// The voxels that `seeds` reach through `open` voxels, face to face, within the leaf; without the
/// seeds that are not open.
LeafWords flooded(const LeafWords& seeds, const LeafWords& open);

}  // namespace vox
