#pragma once

#include "libvox/foot/foot_bins.h"
#include "libvox/grid/openvdb_fwd.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

namespace vox {

class Progress;

struct BandOptions {
  double in = 3;         ///< half width inside, voxels
  double out = 3;        ///< half width outside, voxels
  double voxelSize = 1;  ///< world units
  bool unsignedDistance = false;
  double halfThickness = 0;  ///< voxels, taken from all distances: of a sheet
  bool isPart = false;       ///< there are no cells of some pages; so pages without leaves get no
                             ///< side
};

/// A narrow band of distances.
struct Band {
  std::shared_ptr<openvdb::FloatTree> tree;
  /// Leaves with neighbouring voxels whose distances no closed surface without self-intersections
  /// has: of opposite signs, and together larger than the step from one to the other. Any order.
  std::vector<openvdb::Coord> jumps;
};

/// Distances to the nearest of some cells, in world units. Voxels whose distance is smaller than
/// the band are active; the background is the band, inside the surface negative. Small holes, of
/// voxels that no cell answers for, are closed (band_holes.h).
/// @param bins  cells with a reach of at least the band and the thickness
/// @param part  the share of this in the current stage of `progress`
/// Parallel; the same bits for any number of threads.
/// @throws Cancelled
Band makeBand(const FootBins& bins, const BandOptions& options, Progress& progress, double part);

/// Takes distances beyond smaller widths out of a band.
/// @param options  of the band that is left
void trim(openvdb::FloatTree& band, const BandOptions& options);

/// The value of inactive voxels, without the sign: the smallest float that is not below the width.
/// @param width  voxels
float backgroundOf(double width, double voxelSize);

}  // namespace vox
