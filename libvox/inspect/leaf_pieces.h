#pragma once

#include "libvox/grid/leaf_words.h"
#include "libvox/grid/openvdb_fwd.h"

#include <cstdint>

namespace vox {

/// Which voxels are connected: neighbours through faces, or through edges and corners too.
enum class Neighbours { k6, k26 };

/// Takes the connected piece of the lowest voxel out of the remaining voxels of a leaf.
/// @param left  not empty
LeafWords takePiece(LeafWords& left, Neighbours neighbours);

/// True if a voxel of a leaf is a neighbour of a voxel of the next leaf in direction d.
/// @param d  -1, 0 or 1 along each axis; for k6 along one axis only
bool touch(const LeafWords& words, const openvdb::Coord& d, const LeafWords& other,
           Neighbours neighbours);

/// The voxel with the lowest x, then y, then z.
/// @param words  not empty
openvdb::Coord firstOf(const LeafWords& words);

}  // namespace vox
