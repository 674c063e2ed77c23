#pragma once

#include "libvox/grid/openvdb_fwd.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace vox {

/// Decides which of some enclosed regions are cavities, which stay empty. The argument has one
/// voxel deep inside each region; the result has one answer for each.
using AreCavities = std::function<std::vector<bool>(std::span<const openvdb::Coord>)>;

/// The active voxels of a surface, and all voxels that they enclose: inactive voxels from which no
/// path of inactive voxels, face to face, leads to the outside. Enclosed places without surface
/// become active tiles of the tree. So memory is proportional to the surface, not to the volume or
/// the bounding box.
///
/// @param surface      voxel coordinates within +-2^30; no active tiles at the root
/// @param areCavities  called at most once, if anything is enclosed; may be empty: no cavities
///
/// Parallel; result independent of thread count.
/// @throws LimitError  there are about 2^32 elements (regions and places of nodes) or more
std::shared_ptr<openvdb::MaskTree> filled(const openvdb::MaskTree& surface,
                                          const AreCavities& areCavities);

/// Estimate of the bytes that `filled` needs, with its result but without its argument.
std::uint64_t bytesOfFilling(const openvdb::MaskTree& surface);

}  // namespace vox
