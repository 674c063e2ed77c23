#pragma once

#include "libvox/grid/openvdb.h"
#include "libvox/mesh/polygon_mesh.h"

#include <CLI/CLI.hpp>

#include <functional>
#include <span>

/// What the peers share: programs that do what `vox convert` does in the way its user would
/// otherwise have done it. libvox only reads the mesh for them.
namespace vox::peer {

/// Refines a closed or open manifold, in voxels, until no face is longer than `span` (spanOf), once
/// at least, and makes a grid of it, in index space and with its name.
using Voxelize = std::function<openvdb::GridBase::Ptr(const PolygonMesh& meshIndex, double span)>;

/// Faces up to 1 leave no tunnel between the voxels of their corners. vox stops at this instead,
/// for rounding, and so do the peers, to do the same work for the same voxels; `--span 1` makes a
/// difference where faces are exactly a voxel long: a cube of 2^n voxels is then done a level
/// earlier.
inline constexpr double kDefaultSpan = 0.999;

/// Reads a mesh, scales it to `--dim` voxels along the longest side of its box (world = voxel size
/// x index), voxelizes it, writes the grid to a file and prints "N active voxels". Returns the exit
/// code: 0; 1 cannot be read, converted or written; 4 out of memory.
/// @param app  with the name of the program, and options of its own
int run(int argc, char** argv, CLI::App& app, const Voxelize& voxelize);

/// An empty grid "mask".
openvdb::MaskGrid::Ptr newMask();

/// Longest L-inf edge of a triangulated face: the better diagonal of a quad, the diameter of
/// others.
double spanOf(std::span<const Vec3d> corners);

/// Voxel of a position: each coordinate rounded, halves up.
openvdb::Coord voxelOf(double x, double y, double z);

}  // namespace vox::peer
