#pragma once

#include "libvox/foot/foot_bins.h"
#include "libvox/foot/scan_cell.h"

namespace vox {

/// Which feet of the voxels of a bin count.
struct WantedFeet {
  BinMask voxels;        ///< only those of these voxels
  std::uint64_t leaves;  ///< with some of them: bit i stands for leaf i
  VoxelFloors least;     ///< only those at least this far

  /// Whether a box meets a leaf of the bin with some of the voxels.
  bool meet(const openvdb::CoordBBox& box, const openvdb::Coord& binOrigin) const;
};

/// Keeps the least keys of the voxels of a bin.
/// @param cells   of the bin
/// @param wanted  if not null, only some feet
void scanCells(const FootBins& bins, std::span<const BinnedCell> cells, bool unsignedDistance,
               const WantedFeet* wanted, Feet& feet, FootBrick& brick);

}  // namespace vox
