#pragma once

#include "libvox/grid/openvdb_fwd.h"
#include "libvox/options/volume_options.h"

#include <memory>
#include <optional>

namespace vox {

/// Name of the metadata, of a grid `density` and of its file, with the value of its voxels (float).
inline constexpr const char* kGainMetadata = "vox_gain";

/// Value of `density` at its voxels: the option `gain` if it is set; else 1 for Houdini, and
/// 6 / voxelSize, from 1 to 60000, for Blender. Blender's densities are per unit of length: with
/// this value a shell one voxel thick is opaque (exp(-6) of the light passes). Blender ignores
/// voxels with densities near 0, so the value is at least 1.
/// @param voxelSize  world units
double densityValue(std::optional<double> gain, Target target, double voxelSize);

/// Fog volume `density`: `value` at the active voxels and tiles of the mask, background 0.
std::shared_ptr<openvdb::FloatGrid> densityGrid(const openvdb::MaskTree& mask, float value = 1);

/// The same of a tree of values.
std::shared_ptr<openvdb::FloatGrid> densityGrid(std::shared_ptr<openvdb::FloatTree> values);

}  // namespace vox
