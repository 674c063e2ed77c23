#pragma once

#include "libvox/subdivide/level.h"

#include <span>
#include <vector>

namespace vox {

// The boundary of an extended mesh is the Chaikin polygon of its boundary curve, the closed uniform
// quadratic B-spline of a boundary loop of level 0. A strip face [u1 .. um, Mm, M1] has one edge
// Mm -> M1 on it and is subdivided as half of a 2m-gon. Source: DESIGN section 4.

/// Corners whose edges are boundary, in increasing order. Cost O(C).
std::vector<Index> boundaryCorners(const Adjacency& adjacency);

/// The Chaikin points 3/4 v + 1/4 w and 1/4 v + 3/4 w of each boundary edge v -> w, side by side.
void chaikinPoints(const PolygonMesh& mesh, const Adjacency& adjacency,
                   std::span<const Index> boundary, std::span<Vec3d> points);

/// Corner of face f whose edge is boundary, or kNone.
Index boundaryCornerOf(const SubdivisionLevel& level, Index f);

/// sin t_i and cos t_i / cos t_1 with t_i = pi (2i - 1) / (2m), for i = 1 .. m.
struct StripWeight {
  double sine;
  double ratio;
};
std::vector<StripWeight> stripWeights(Index m);

/// Image vertices of strip face f with m + 2 corners, given its boundary corner and the weights for
/// m; written to the slots of its corners. O(m). For m = 2, the regular case, the weights are
/// exact multiples of 1/8, and `weights` is not used.
void imageOfStrip(const PolygonMesh& mesh, Index f, Index boundaryCorner,
                  std::span<const StripWeight> weights, std::vector<Vec3d>& image);

}  // namespace vox
