#pragma once

#include "libvox/core/types.h"

#include <openvdb/openvdb.h>

#include <cmath>
#include <cstdint>
#include <span>

namespace vox {

/// Longest L-inf face span, in voxels, that vertex conversion accepts. The guarantee holds up to 1;
/// the rest is for rounding.
inline constexpr double kVertexConversionSpan = 0.999;

/// Voxel that holds a position (index space, |coordinate| < 2^31): each coordinate rounded, halves
/// up. The one rounding rule of the program.
inline openvdb::Coord voxelOf(const Vec3d& positionIndex) {
  const auto round = [](double x) { return static_cast<openvdb::Int32>(std::floor(x + 0.5)); };
  return {round(positionIndex.x()), round(positionIndex.y()), round(positionIndex.z())};
}

/// Nodes of an OpenVDB tree (leaves of 8^3 voxels, inner nodes of 128^3 and 4096^3) that hold the
/// voxels of some positions.
struct TreeFootprint {
  std::uint64_t leaves = 0;
  std::uint64_t lowerNodes = 0;
  std::uint64_t upperNodes = 0;
};
/// The footprint that markVertices of these positions will have in an empty grid. Parallel.
TreeFootprint footprintOf(std::span<const Vec3d> positionsIndex);

/// Vertex conversion: activates the voxel of each position (index space).
///
/// If every face of the mesh has faceSpan <= 1, the active voxels 6-separate its sides. Rounding
/// moves the corners of a triangle of such L-inf edges to corners of one unit cube, so the rounded
/// surface, nowhere farther than 1/2 (L-inf) from the surface, meets a step between neighbouring
/// voxel centres only at active voxels: no path of inactive voxels, face to face, crosses it. (A
/// single step may cross the surface itself, into a pocket that leads nowhere.)
///
/// Parallel, one tree per thread; activation commutes, so the result does not depend on their
/// number.
/// Source: paper section 5, with the L-inf criterion of DESIGN section 6.
void markVertices(std::span<const Vec3d> positionsIndex, openvdb::MaskGrid& mask);

}  // namespace vox
