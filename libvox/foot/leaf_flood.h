#pragma once

#include <array>
#include <cstdint>

namespace vox {

/// The voxels of a leaf as bits: bit y << 3 | z of word x.
using LeafBits = std::array<std::uint64_t, 8>;

/// The voxels that `seeds` reach through `open` voxels, face to face, within the leaf; without the
/// seeds that are not open.
LeafBits flooded(const LeafBits& seeds, const LeafBits& open);

/// The voxels of a leaf that have a face in common with a voxel of a set.
LeafBits neighboursOf(const LeafBits& voxels);

}  // namespace vox
