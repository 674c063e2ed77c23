#pragma once

#include "libvox/mesh/adjacency.h"
#include "libvox/mesh/polygon_mesh.h"

#include <span>
#include <vector>

namespace vox {

/// Control points C of the closed uniform quadratic B-spline that passes through `points`, through
/// each in the middle of its span: C[i-1]/8 + 3/4 C[i] + C[i+1]/8 = points[i], cyclically. There
/// may be any number of points: with two, C[i-1] and C[i+1] are the same point; a single point is
/// its own control point.
///
/// Cost O(n). The matrix is circulant and its condition number at most 2; it is inverted by two
/// recursive filters that damp every rounding error by 0.17 per point.
/// Source: M. Unser, A. Aldroubi, M. Eden, B-spline signal processing, 1993.
std::vector<Vec3d> interpolatingControls(std::span<const Vec3d> points);

/// Moves the vertices of each boundary loop so that the boundary curve of the extended surface
/// passes through their old positions. All other vertices stay.
/// @throws MeshError  a vertex is on the boundary more than once (a bow tie): one control point
///   cannot fit two curves; the message names the vertex
PolygonMesh interpolateBoundary(PolygonMesh mesh, const Adjacency& adjacency);

}  // namespace vox
