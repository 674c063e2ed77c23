#pragma once

#include "libvox/grid/leaf_words.h"

#include <cstdint>

namespace vox {

/// Switches on further voxels of a leaf.
/// @param bits  the 8 words of the leaf
/// @param more  the voxels to switch on
/// @return      how many of these were off before
std::uint32_t mergeLeaf(std::uint64_t* bits, const LeafWords& more);

}  // namespace vox
