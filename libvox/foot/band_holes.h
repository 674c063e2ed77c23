#pragma once

#include "libvox/foot/band.h"
#include "libvox/grid/openvdb_fwd.h"

#include <cstddef>

namespace vox {

/// Makes voxels active that a band lacks though a neighbour of theirs is more than a voxel away
/// from the end of the band. Their distances continue those around: the mean of two opposite
/// neighbours, or a line through two voxels on one side. A hole is closed if it is at most six
/// voxels wide. A band without holes keeps its bits.
/// @param options  of the band
/// @return  number of voxels made active. If there are any, the signs of inactive voxels may be
///   wrong, because the inside has been flooded through the holes.
/// Parallel; the same bits for any number of threads.
std::size_t closeHoles(openvdb::FloatTree& band, const BandOptions& options);

}  // namespace vox
