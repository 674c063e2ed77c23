#pragma once

#include "libvox/mesh/adjacency.h"
#include "libvox/mesh/polygon_mesh.h"

#include <span>
#include <vector>

namespace vox {

/// Control points of the closed uniform quadratic B-spline that passes through `points`, each at
/// the middle of its span: the C with C[i-1]/8 + 3/4 C[i] + C[i+1]/8 = points[i], cyclically. Any
/// number of points >= 1: with two, C[i-1] and C[i+1] are the same point; one is its own control.
///
/// Cost O(n). The matrix is circulant and its condition number at most 2; it is inverted by two
/// recursive filters that damp every rounding error by 0.17 per point.
/// Source: M. Unser, A. Aldroubi, M. Eden, B-spline signal processing, 1993.
std::vector<Vec3d> interpolatingControls(std::span<const Vec3d> points);

/// Moves the vertices of each boundary loop so that the boundary curve of the extended surface
/// passes through where they were; all others stay.
/// @throws MeshError  a vertex is on the boundary more than once (a bow tie), which no single
///   control point can serve; the message names it
PolygonMesh interpolateBoundary(PolygonMesh mesh, const Adjacency& adjacency);

}  // namespace vox
