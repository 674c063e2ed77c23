#pragma once

#include "libvox/grid/openvdb.h"
#include "tests/closest_point.h"

#include <cstddef>

namespace vox::test {

/// How a level set differs from the truth. Lengths in voxels.
struct LevelSetErrors {
  std::size_t active = 0;      ///< active voxels looked at
  double rms = 0;              ///< of the errors of their values
  double largest = 0;          ///< of these errors
  std::size_t wrongSigns = 0;  ///< active voxels with a wrong sign
  std::size_t surplus = 0;     ///< active voxels outside the band

  std::size_t near = 0;     ///< voxels of the band looked at, whether active or not
  std::size_t missing = 0;  ///< inactive ones among them

  std::size_t inactive = 0;          ///< inactive voxels looked at, in the band and far from it
  std::size_t wrongBackgrounds = 0;  ///< their values that are not a background
  std::size_t wrongSides = 0;        ///< their values with a wrong sign
};

/// Compares a level set with the signed distances of `truth` at voxels chosen by hashes.
///
/// Signs count if the voxel is more than 0.02 off the surface and off its tangent plane there (at
/// boundaries, the latter is closer). The error of a value with a wrong sign is that of its size.
/// Voxels within 0.02 of the limits of the band may be active or not. Inactive values are those of
/// the background, or inside -bandIn.
///
/// @param truth      in index space
/// @param voxelSize  unit of the values
/// @param bandIn     half width of the band inside, in voxels
/// @param bandOut    outside
/// @param samples    about how many voxels of each kind to look at. Active ones: all, if they are
///                   fewer.
LevelSetErrors compareLevelSet(const openvdb::FloatGrid& grid, const Surface& truth,
                               double voxelSize, double bandIn, double bandOut,
                               std::size_t samples);

}  // namespace vox::test
