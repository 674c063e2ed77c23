#pragma once

#include "libvox/core/types.h"
#include "libvox/options/voxelize.h"

#include <array>
#include <bit>
#include <cstdint>
#include <span>
#include <type_traits>

namespace vox {

/// Spacing of the lattice of the scan, in voxels. Corners of triangles are moved to the nearest
/// lattice point, halves to even.
inline constexpr double kScanLattice = 1.0 / 65536;

/// Active voxels of one triangle within a block of 4 x 4 x 4: bit 16 i + 4 j + k of `voxels` stands
/// for voxel (x + i, y + j, z + k). The block may lie anywhere; some bit is set.
struct VoxelBlock {
  std::array<std::int32_t, 3> origin;
  Index triangle;
  std::uint64_t voxels;
};

/// Calls visit(x, y, z) for each voxel of a block.
template <class Visit>
void forEachVoxel(const VoxelBlock& block, Visit&& visit) {
  for (std::uint64_t rest = block.voxels; rest != 0; rest &= rest - 1) {
    const int bit = std::countr_zero(rest);
    visit(block.origin[0] + (bit >> 4), block.origin[1] + (bit >> 2 & 3),
          block.origin[2] + (bit & 3));
  }
}

namespace detail {

using EmitBlocks = void (*)(void* visit, std::span<const VoxelBlock> blocks);
void scanTriangles(std::span<const Vec3d> points, std::span<const std::array<Index, 3>> triangles,
                   Separation separation, EmitBlocks emit, void* visit);
void scanTriangle(std::span<const Vec3d, 3> corners, Separation separation, EmitBlocks emit,
                  void* visit);
void scanPart(std::span<const Vec3d, 3> corners, std::int64_t part, Separation separation,
              EmitBlocks emit, void* visit);

template <class Visit>
void emitTo(void* visit, std::span<const VoxelBlock> blocks) {
  for (const VoxelBlock& block : blocks) (*static_cast<Visit*>(visit))(block);
}

}  // namespace detail

/// Polygon voxelization: the active voxels of triangles in index space. Voxel (i, j, k) is the unit
/// cube centred at that point. Calls visit(const VoxelBlock&); each active voxel of a triangle is
/// in exactly one of its blocks, which come in no particular order.
///
/// The predicate, for the snapped triangle T (corners on the lattice) and a voxel of centre c:
///   26: active iff T meets the closed cube of c;
///   6:  active iff T meets one of the three closed segments of length 1 through c along the axes.
/// It is decided in integers, exactly, both ways: touching counts, nothing else does. T may be
/// degenerate, a segment or a point; winding and order of the corners do not matter.
///
/// Why there are no tunnels. Let S be the union of triangles that share corners: it snaps to a
/// surface without gaps, at most half a lattice step (2^-17 voxel, per coordinate) from S.
///   6:  the step from a voxel to its neighbour is half a segment of each; where the surface meets
///       it, one of the two is active. A path of inactive voxels, face to face, never meets it.
///   26: the closed cubes of neighbours share a point, and no inactive cube meets the snapped
///       surface; so neither does the union of the cubes of an inactive path.
///
/// Cost: O(columns + perimeter) along the axis that the triangle faces most; triangles of up to 16
/// voxels across go block by block, several at a time, through the processor's vector unit, with
/// the same result.
///
/// @param points     index space, unit: voxels; |coordinate| <= 2^30
/// @param triangles  corners as indices into points; VoxelBlock::triangle counts in this list
/// @throws LimitError  a coordinate is larger or not finite, or a triangle longer than 2^30 along
///   an axis; triangles before it may have been visited
///
/// Thread-safe; assumes the default rounding mode of the processor. Source: paper section 6; the
/// targets of Cohen-Or & Kaufman 1995, "Fundamentals of surface voxelization"; the separating axis
/// theorem.
template <class Visit>
void scanTriangles(std::span<const Vec3d> points, std::span<const std::array<Index, 3>> triangles,
                   Separation separation, Visit&& visit) {
  using Plain = std::remove_reference_t<Visit>;
  detail::scanTriangles(points, triangles, separation, &detail::emitTo<Plain>, &visit);
}

/// Scans one triangle, which has number 0; as scanTriangles.
template <class Visit>
void scanTriangle(std::span<const Vec3d, 3> corners, Separation separation, Visit&& visit) {
  using Plain = std::remove_reference_t<Visit>;
  detail::scanTriangle(corners, separation, &detail::emitTo<Plain>, &visit);
}

/// Number of parts of a triangle that can be scanned separately, by different threads. A part has
/// 256 rows of voxels.
/// @throws LimitError  as scanTriangles
std::int64_t scanPartCount(std::span<const Vec3d, 3> corners);

/// Scans one part of a triangle. All parts together have the voxels of scanTriangle, each once.
/// @param part  0 .. scanPartCount(corners) - 1
template <class Visit>
void scanTrianglePart(std::span<const Vec3d, 3> corners, std::int64_t part, Separation separation,
                      Visit&& visit) {
  using Plain = std::remove_reference_t<Visit>;
  detail::scanPart(corners, part, separation, &detail::emitTo<Plain>, &visit);
}

}  // namespace vox
