#pragma once

#include <array>
#include <optional>
#include <string>

namespace vox {

/// Where the voxels of a grid lie.
struct FileLattice {
  double voxelSize;              ///< world units
  std::array<double, 3> origin;  ///< world position of the centre of voxel (0, 0, 0)
  /// The lowest and the highest coordinates of active voxels, if asked for.
  std::optional<std::array<int, 6>> activeBox;
};

/// Reads the lattice of a grid in a .vdb file from any program. If values are loaded on demand
/// (readVdb), they stay in the file.
/// @param reference  "FILE.vdb": the first grid, or "FILE.vdb:NAME". A file that has the whole text
///   as its name wins.
/// @param withBox    whether activeBox is wanted
/// @throws InputError  as readVdb; there is no such grid; its voxels are no cubes along the axes;
/// it
///   has no active voxel, but the box is wanted
FileLattice readLattice(const std::string& reference, bool withBox);

}  // namespace vox
