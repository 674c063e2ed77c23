#pragma once

#include "libvox/grid/openvdb.h"
#include "libvox/mesh/polygon_mesh.h"

#include <CLI/CLI.hpp>

#include <functional>
#include <span>

/// Common code of the peers: programs that do the work of `vox convert` in other ways. They use
/// libvox only to read the mesh.
namespace vox::peer {

/// Refines a closed or open manifold, given in voxels, at least once and until the span of every
/// face is at most `span` (spanOf); makes a grid in index space, with its name.
using Voxelize = std::function<openvdb::GridBase::Ptr(const PolygonMesh& meshIndex, double span)>;

/// Default of `--span`. A span of 1 is enough to leave no tunnel between the voxels of the corners.
/// vox stops at 0.999 because of rounding errors, and so do the peers, so that all make the same
/// voxels with the same work. `--span 1` matters if faces are exactly one voxel long: a cube of 2^n
/// voxels then needs one level less.
inline constexpr double kDefaultSpan = 0.999;

/// Reads a mesh, scales it to `--dim` voxels along the longest side of its box (world = voxel size
/// x index), voxelizes it, writes the grid to a file and prints "N active voxels". Returns the exit
/// code: 0; 1 cannot be read, converted or written; 4 out of memory.
/// @param app  with the name of the program, and options of its own
int run(int argc, char** argv, CLI::App& app, const Voxelize& voxelize);

/// An empty grid "mask".
openvdb::MaskGrid::Ptr newMask();

/// Longest L-inf edge of a face that is cut into triangles: of a quad with its shorter diagonal; of
/// other faces the diameter.
double spanOf(std::span<const Vec3d> corners);

/// Voxel of a position: each coordinate rounded, halves up.
openvdb::Coord voxelOf(double x, double y, double z);

}  // namespace vox::peer
