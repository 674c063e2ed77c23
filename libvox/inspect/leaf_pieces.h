#pragma once

#include "libvox/grid/merge_leaf.h"
#include "libvox/grid/openvdb_fwd.h"

#include <cstdint>

namespace vox {

/// Which voxels hang together: neighbours through faces, or through edges and corners too.
enum class Neighbours { k6, k26 };

/// Takes the connected piece of the lowest voxel out of what is left of a leaf, which is not empty.
LeafWords takePiece(LeafWords& left, Neighbours neighbours);

/// Whether some voxel of a leaf is a neighbour of some voxel of the leaf next to it in direction d,
/// of -1, 0, 1 each; for k6 one of the six axes.
bool touch(const LeafWords& words, const openvdb::Coord& d, const LeafWords& other,
           Neighbours neighbours);

std::uint64_t countOf(const LeafWords& words);

/// Lowest voxel in the order of x, y, z; of a leaf that is not empty.
openvdb::Coord firstOf(const LeafWords& words);

}  // namespace vox
