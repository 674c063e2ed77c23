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

/// The same for an open curve: the controls between a first and a last one, which are fixed, so
/// that controls[i-1]/8 + 3/4 controls[i] + controls[i+1]/8 = points[i]. Cost O(n).
std::vector<Vec3d> interpolatingControls(const Vec3d& start, std::span<const Vec3d> points,
                                         const Vec3d& end);

/// Where a mesh was cut along creases (CutMesh); both are empty if it was not.
struct CreaseCut {
  std::span<const Index> seam;
  std::span<const Index> pointOrigin;
};

/// Moves the vertices of each boundary loop so that the boundary curve of the extended surface
/// passes through their old positions. Corners of creases, through which it passes already, and all
/// other vertices stay. The copies of a vertex on the two sides of a crease get the same bits.
/// @throws MeshError  a vertex is on the boundary more than once (a bow tie): one control point
///   cannot fit two curves; the message names the vertex
PolygonMesh interpolateBoundary(PolygonMesh mesh, const Adjacency& adjacency,
                                const CreaseCut& cut = {});

}  // namespace vox
