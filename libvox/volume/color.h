#pragma once

#include "libvox/core/color.h"
#include "libvox/core/parallel.h"
#include "libvox/grid/openvdb.h"

#include <openvdb/tree/LeafManager.h>

namespace vox {

/// Grid `color`: kPlainColor at the voxels of the mask, background 0, transform of the mask.
openvdb::Vec3SGrid::Ptr colorGrid(const openvdb::MaskGrid& mask);

/// Sets the colours of voxels of a colour grid. Parallel over leaves.
/// @param voxels   without tiles; all of them must be active in the grid
/// @param colorOf  returns the linear colour of a voxel, as openvdb::Vec3f(const openvdb::Coord&);
///   must be thread-safe
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
