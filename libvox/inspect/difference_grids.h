#pragma once

#include "libvox/grid/openvdb.h"
#include "libvox/inspect/diff.h"

namespace vox {

/// What differs between two grids, voxel by voxel of their index spaces.
struct DifferenceGrids {
  openvdb::MaskGrid::Ptr onlyA, onlyB;  ///< active in one of them
  openvdb::FloatGrid::Ptr values;  ///< |a - b| (ValueDiff) where both are active and differ by more
                                   ///< than the tolerance; null if types differ or have no values
};

/// They have the transform of A.
/// @throws InputError  a type that cannot be compared
/// @throws UsageError  a tolerance is negative or not finite
DifferenceGrids differenceGrids(const openvdb::GridBase& a, const openvdb::GridBase& b,
                                const DiffOptions& options);

}  // namespace vox
