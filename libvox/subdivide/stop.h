#pragma once

#include "libvox/mesh/patch.h"
#include "libvox/subdivide/patch_steps.h"

#include <span>

namespace vox {

// A vertex is fine enough for vertex conversion if every face around it, at its own level, has an
// L-inf diameter of at most kVertexConversionSpan. The whole diameter counts, not only edges and
// one diagonal: other corners of a face may be subdivided further, and their descendants stay in
// the convex hull of the faces that both share; so the faces between the levels fit into a voxel,
// too. All lengths in voxels. Source: paper section 5; DESIGN sections 8 and 9.

/// Largest L-inf diameter of a face that is fine enough for vertex conversion. The guarantee holds
/// up to 1; the difference is for rounding errors.
inline constexpr double kVertexConversionSpan = 0.999;

/// L-inf diameter of at least one point: the longest side of their box.
inline double diameter(std::span<const Vec3d> points) {
  Vec3d low = points[0];
  Vec3d high = points[0];
  for (const Vec3d& point : points.subspan(1)) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  return (high - low).maxCoeff();
}

/// L-inf diameter of a quad.
inline double diameter(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
  const Vec3d low = a.cwiseMin(b).cwiseMin(c.cwiseMin(d));
  const Vec3d high = a.cwiseMax(b).cwiseMax(c.cwiseMax(d));
  return (high - low).maxCoeff();
}

/// The bound C(n) of DESIGN section 8 for a face of n sides. With D the largest diameter and C the
/// largest C(n) of the faces around a vertex, the faces k levels below measure at most 2^-k C D.
double contraction(std::size_t sides);

/// Whether all four children of an irregular vertex are fine enough.
/// @param largestDiameter, largestContraction  of the faces around it; none may be a strip face
bool childrenFineEnough(double largestDiameter, double largestContraction);

/// Number of levels below a regular vertex at which all its descendants are fine enough; 0 if it is
/// fine enough itself. Each level halves and averages the differences between neighbours, so the
/// faces k levels down measure at most 2^-k (max |du| + max |dv|), for each coordinate by itself.
int patchDepth(const Patch& patch);

/// Number of levels below a vertex of the boundary curve of an extended surface at which it is fine
/// enough. A bound for strip faces of any number of sides: a strip face is half of a face of at
/// most twice its size, and C(n) < 3 (DESIGN section 8).
/// @param stripDiameter  largest diameter of the strip faces at the vertex
int curveDepth(double stripDiameter);

}  // namespace vox
