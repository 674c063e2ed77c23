#pragma once

#include "libvox/grid/openvdb_fwd.h"

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace vox {

/// Voxels that close the openings of a surface.
struct Closure {
  std::shared_ptr<openvdb::MaskTree> voxels;  ///< inactive voxels of the surface; null if none
  std::uint64_t voxelCount = 0;
  std::uint64_t openings = 0;  ///< sets of these voxels, joined through faces, edges and corners
  /// Where the closing voxels meet the outside: pairs of neighbours, inside and outside.
  std::vector<std::pair<openvdb::Coord, openvdb::Coord>> sides;
};

/// Closes openings of a voxel surface that are narrower than `width` voxels, if they lead to a
/// space that is at least as wide. Grooves and dents of the outside stay: only the way into such a
/// space is closed, at its narrowest place.
///
/// A ball of `width` voxels is moved from the outside as far as it can go without touching the
/// surface. Places that it does not reach, but where it has room, are inside. From there and from
/// the outside all other voxels are taken, layer by layer; where both meet, the opening is closed.
/// The ball is an octagonal one, as wide as the voxels along the axes, and within 4 % along their
/// diagonals. A ball of an even width has no voxel as its centre: then the closing voxels may lie a
/// voxel deeper.
///
/// @param width  2 or more; with less nothing is narrower
/// Memory and time are proportional to the voxels of the surface times the width. The result does
/// not depend on the number of threads.
/// @throws LimitError  as filled (fill.h)
Closure closureOf(const openvdb::MaskTree& surface, int width);

/// Estimate of the bytes that closureOf needs.
std::uint64_t bytesOfClosing(const openvdb::MaskTree& surface, int width);

}  // namespace vox
