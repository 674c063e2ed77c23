#pragma once

#include "libvox/mesh/flat_polygon.h"

#include <span>
#include <vector>

namespace vox {

/// Cuts a region of a plane, with or without holes, into few convex parts of good shape. Each side
/// of the region is a side of one part; all other sides of parts are diagonals that two parts
/// share.
///
/// Steps: the holes are joined to the outline (joinHoles); ears are clipped (triangulate.h);
/// diagonals are flipped while that makes the smallest angle at them larger, which is Delaunay's
/// choice; then diagonals are removed, the longest first, as long as the parts stay convex and do
/// not bulge. A corner counts as convex if it is flat, or bends inward by less than 1e-4 (the sine)
/// and 1e-7 of the region.
///
/// A part bulges if, at a corner where the region bends inward, the image of Doo-Sabin lies on the
/// outward side of the corner, by more than a quarter of the shorter side there: then the smooth
/// surface would leave the region. (The back of a comb, as one part, has images far from the
/// roots of the teeth.) Parts at such corners have at most 256 corners.
///
/// @param positions  of all corners, in space, finite
/// @param flat       their projection (flattened)
/// @param loops      the outline, counter-clockwise in the projection, then holes, clockwise
/// @param parts      replaced by lists of corners, counter-clockwise
/// @return  false if the region has no triangulation of triangles with an area: loops cross, or
///   corners lie on each other
///
/// Deterministic, thread-safe. Cost: that of triangulate and joinHoles, and O(n log n); the number
/// of flips is limited to 64 n.
/// Source: S. Hertel, K. Mehlhorn, Fast triangulation of simple polygons, 1983; C. Lawson, Software
/// for C1 surface interpolation, 1977.
bool convexParts(std::span<const Vec3d> positions, std::span<const FlatPoint> flat,
                 std::span<const std::vector<Index>> loops, std::vector<std::vector<Index>>& parts);

}  // namespace vox
