#pragma once

#include "libvox/foot/foot_bins.h"
#include "libvox/grid/openvdb_fwd.h"

#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>

namespace vox {

class Progress;

struct BandOptions {
  double in = 3;         ///< half width inside, voxels
  double out = 3;        ///< half width outside, voxels
  double voxelSize = 1;  ///< world units
  bool unsignedDistance = false;
  double halfThickness = 0;  ///< voxels, taken from all distances: of a sheet
};

/// Voxels that decide what is inside where the nearest surface alone does not: where surfaces
/// overlap, or have small holes.
struct Inside {
  const openvdb::MaskTree* surface = nullptr;  ///< voxels that a surface crosses
  const openvdb::MaskTree* solid = nullptr;    ///< these, and what they enclose
};

/// The smallest float that is not below a value. (OpenVDB refuses a band a little below 3 voxels as
/// too narrow.)
inline float notBelow(double value) {
  const auto nearest = static_cast<float>(value);
  return double{nearest} < value ? std::nextafter(nearest, std::numeric_limits<float>::max())
                                 : nearest;
}

/// A narrow band of distances.
struct Band {
  std::shared_ptr<openvdb::FloatTree> tree;
  /// Pairs of neighbouring voxels with distances that no closed surface without self-intersections
  /// has: of opposite signs, and together larger than the step from one to the other.
  std::uint64_t jumps = 0;
};

/// Distances to the nearest of some cells, in world units. Voxels whose distance is smaller than
/// the band are active; the background is the band, inside the surface negative.
/// @param bins    cells with a reach of at least the band and the thickness
/// @param inside  if set, a voxel is inside if it is solid; a voxel that a surface crosses: if it
///   lies on the inner side of its foot, or has none near
/// @param part    the share of this in the current stage of `progress`
/// Parallel; the same bits for any number of threads.
/// @throws Cancelled
Band makeBand(const FootBins& bins, const BandOptions& options, const Inside& inside,
              Progress& progress, double part);

}  // namespace vox
