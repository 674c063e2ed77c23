#pragma once

#include "libvox/grid/openvdb.h"

#include <cstdint>

namespace vox {

/// Pairs of voxels whose values cannot be distances to one surface.
struct SteepPairs {
  std::uint64_t count = 0;
  openvdb::Coord first;  ///< the lowest voxel of all pairs, if there are any
};

/// Counts the pairs of active voxels, neighbours through a face, whose values differ by more than
/// 1.1 times the distance of their centres. Exact distances differ by no more than this distance:
/// also where two parts of a surface are equally near, and the gradient may have any norm up to
/// sqrt(3). Looks at voxels only, not at tiles. The values of a grid that is stored in 16 bits may
/// be off by the rounding, besides. For grids of floats and doubles with a linear transform.
/// Parallel over leaves; result independent of thread count.
/// @throws InputError  values cannot be read
template <class Grid>
SteepPairs steepPairs(const Grid& grid);

}  // namespace vox
