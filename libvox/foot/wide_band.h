#pragma once

#include "libvox/foot/band.h"
#include "libvox/foot/foot_bins.h"
#include "libvox/grid/openvdb_fwd.h"

namespace vox {

class Progress;

/// Makes a band of distances wider, voxel by voxel in the order of distance. The candidates for the
/// nearest cell of a voxel are those of its neighbours, because feet hardly move from a voxel to
/// the next one. That takes the same time for every voxel, while the tubes of cells spread with the
/// distance.
///
/// Distances are those to real points of the surface, and nearly always to the nearest.
///
/// @param band   the band of makeBand with the half width `exact`, or parts of it that are united
/// @param exact  voxels, at least 3
/// @param bins   cells of the same surfaces with a reach of at least `exact` and half the
/// thickness,
///   without polynomial cells
/// @param options  of the result
/// Parallel; the same bits for any number of threads.
/// @throws Cancelled
void widen(openvdb::FloatTree& band, double exact, const FootBins& bins, const BandOptions& options,
           Progress& progress);

}  // namespace vox
