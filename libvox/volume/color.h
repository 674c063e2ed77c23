#pragma once

#include "libvox/core/parallel.h"
#include "libvox/grid/openvdb.h"

#include <openvdb/tree/LeafManager.h>

namespace vox {

/// Linear colour of what has none of its own.
inline constexpr float kPlainColor = 0.8F;

/// Grid `color`: kPlainColor at the voxels of the mask, background 0, the mask's transform.
openvdb::Vec3SGrid::Ptr colorGrid(const openvdb::MaskGrid& mask);

/// Gives voxels of a colour grid new colours. Parallel by leaf.
/// @param voxels   all in leaves, all active in the grid
/// @param colorOf  linear colour of a voxel: openvdb::Vec3f(const openvdb::Coord&); thread-safe
template <class ColorOf>
void paint(openvdb::Vec3SGrid& color, const openvdb::MaskTree& voxels, ColorOf&& colorOf) {
  const openvdb::tree::LeafManager<const openvdb::MaskTree> leaves(voxels);
  parallelForEach(leaves.leafCount(), 1, [&](std::size_t n) {
    const auto& from = leaves.leaf(n);
    auto* const to = color.tree().probeLeaf(from.origin());
    for (auto voxel = from.cbeginValueOn(); voxel; ++voxel)
      to->setValueOnly(voxel.pos(), colorOf(voxel.getCoord()));
  });
}

}  // namespace vox
