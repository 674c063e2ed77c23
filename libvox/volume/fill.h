#pragma once

#include "libvox/grid/openvdb_fwd.h"

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace vox {

/// Which of some enclosed regions stay empty, given a voxel deep inside each.
using AreCavities = std::function<std::vector<bool>(std::span<const openvdb::Coord>)>;

/// The voxels of a surface and those it encloses: every inactive voxel from which no path of
/// inactive voxels, face to face, leads out. What is enclosed and free of surface is active tiles,
/// as large as the tree has them; so memory follows the surface, not the volume or the bounding
/// box.
///
/// @param surface      active voxels, within +-2^30; no active tiles at the root
/// @param areCavities  asked once, unless it is empty or nothing is enclosed
///
/// Parallel; the result does not depend on the number of threads.
/// @throws LimitError  some 2^32 leaves or more
std::shared_ptr<openvdb::MaskTree> filled(const openvdb::MaskTree& surface,
                                          const AreCavities& areCavities);

/// Bytes that `filled` needs besides its argument, its result included.
std::uint64_t bytesOfFilling(const openvdb::MaskTree& surface);

}  // namespace vox
