#pragma once

#include "libvox/grid/openvdb.h"

namespace vox {

/// Whether a voxel and its 26 neighbours are all solid. Where a surface has the outside on one
/// side, each voxel that it crosses has a neighbour outside; so a surface in an enclosed voxel lies
/// within others.
inline bool isEnclosed(const openvdb::tree::ValueAccessor<const openvdb::MaskTree>& solid,
                       const openvdb::Coord& voxel) {
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z)
        if (!solid.isValueOn(voxel.offsetBy(x, y, z))) return false;
  return true;
}

}  // namespace vox
