#pragma once

#include "libvox/core/memory.h"
#include "libvox/core/progress.h"
#include "libvox/options/volume_options.h"

#include <openvdb/openvdb.h>

#include <span>

namespace vox {

struct PreparedSurface;

inline constexpr double kDefaultBand = 3;
inline constexpr double kDefaultTolerance = 0.05;

/// The grid `surface`: signed distances to the smooth surfaces of all objects (to the polygons of
/// those that stop at a level), as narrow as the band. It is made of polygons that follow them
/// within the tolerance, never of voxels.
///
/// Closed components that face outward are united, those that face inward taken out of what they
/// lie in; components without inside are sheets one voxel thick, or with OpenMesh::kUnsigned
/// distances without sign. Components that stay apart are made together. Where there are more than
/// 20000 closed ones, all are, and faces inside others stay as seams within.
///
/// @throws LimitError
/// @throws Cancelled
openvdb::FloatGrid::Ptr surfaceGrid(std::span<const PreparedSurface> surfaces,
                                    const VolumeOptions& options,
                                    const openvdb::math::Transform& transform, MemoryBudget& budget,
                                    const Progress& progress);

}  // namespace vox
