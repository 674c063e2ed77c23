#pragma once

#include "libvox/subdivide/level.h"

#include <span>
#include <vector>

namespace vox {

// The boundary of an extended mesh is the Chaikin polygon of its boundary curve. This curve is the
// closed uniform quadratic B-spline of a boundary loop of level 0. A strip face [u1 .. um, Mm, M1]
// has the one edge Mm -> M1 on the boundary and is subdivided like half of a 2m-gon.
// Source: DESIGN section 4.

/// Corners whose edges are boundary, in increasing order. Cost O(C).
std::vector<Index> boundaryCorners(const Adjacency& adjacency);

/// The Chaikin points of boundary edges: for each edge v -> w first 3/4 v + 1/4 w, then
/// 1/4 v + 3/4 w. Parallel.
/// @param boundary  corners of these edges
/// @param points    result; two per edge
void chaikinPoints(const PolygonMesh& mesh, const Adjacency& adjacency,
                   std::span<const Index> boundary, std::span<Vec3d> points);

/// The corner of face f whose edge is boundary, or kNone.
Index boundaryCornerOf(const SubdivisionLevel& level, Index f);

/// Weights of the corners of a strip face; t_i = pi (2i - 1) / (2m).
struct StripWeight {
  double sine;   ///< sin t_i
  double ratio;  ///< cos t_i / cos t_1
};
/// The weights for i = 1 .. m.
std::vector<StripWeight> stripWeights(Index m);

/// Computes the image vertices of strip face f with m + 2 corners. Cost O(m).
/// @param weights  stripWeights(m); not used for m <= 2
/// @param image    result; the slots of the corners of f are written
void imageOfStrip(const PolygonMesh& mesh, Index f, Index boundaryCorner,
                  std::span<const StripWeight> weights, std::vector<Vec3d>& image);

}  // namespace vox
