#pragma once

#include <array>
#include <cstdint>

namespace vox {

/// The voxels of a leaf, one bit each, in OpenVDB's order: word x, bit 8 y + z.
using LeafWords = std::array<std::uint64_t, 8>;

/// Switches on further voxels of a leaf.
/// @param bits  the 8 words of the leaf
/// @param more  the voxels to switch on
/// @return      how many of these were off before
std::uint32_t mergeLeaf(std::uint64_t* bits, const LeafWords& more);

}  // namespace vox
