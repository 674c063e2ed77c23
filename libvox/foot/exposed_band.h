#pragma once

#include "libvox/foot/band.h"
#include "libvox/foot/foot_bins.h"
#include "libvox/grid/openvdb_fwd.h"

#include <memory>

namespace vox {

class Progress;

/// The voxels of a band that separate: those on the inner side of their feet, and those that the
/// surface may cross on the way to a neighbour. What they do not enclose is outside.
std::shared_ptr<openvdb::MaskTree> wallsOf(const openvdb::FloatTree& band, double voxelSize);

/// Corrects a band where parts of its surface lie inside others. Outside the solid voxels distances
/// become positive, and inside they become those to the nearest part of the surface that the
/// outside touches.
/// @param band    of the cells, from makeBand with `options`: as wide inside as outside, at least
///   kLeastToExpose
/// @param solid   voxels that are not surely outside; those that turn out to be are taken out
/// @param hidden  voxels this far on the outer side of their feet are outside or hidden: not
///   crossed by the surface
/// Parallel; the same bits for any number of threads.
/// @throws Cancelled
void expose(const Band& band, const FootBins& bins, openvdb::MaskTree& solid, double hidden,
            const BandOptions& options, const Progress& progress);

inline constexpr double kLeastToExpose = 2.5;  ///< half width of a band, voxels
/// Voxels farther than this, on the outer side of their feet, are no walls (wallsOf). In voxels.
inline constexpr double kLeastOfFree = 0.51;

}  // namespace vox
