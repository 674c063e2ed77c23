#pragma once

#include "libvox/grid/openvdb_fwd.h"
#include "libvox/options/volume_options.h"

#include <memory>
#include <optional>

namespace vox {

/// Metadata of a grid `density`, and of its file: the value at its voxels (float).
inline constexpr const char* kGainMetadata = "vox_gain";

/// What `density` holds at its voxels: the gain, or what suits the target. Blender takes densities
/// per unit of length, so that a shell one voxel thick is opaque there from 6 / voxel size on
/// (exp(-6) of the light passes), and drops voxels of next to nothing: 1 at least.
/// @param voxelSize  world units
double densityValue(std::optional<double> gain, Target target, double voxelSize);

/// Fog volume `density`: `value` at the voxels and tiles of the mask, background 0.
std::shared_ptr<openvdb::FloatGrid> densityGrid(const openvdb::MaskTree& mask, float value = 1);

}  // namespace vox
