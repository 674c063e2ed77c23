#pragma once

#include "libvox/mesh/patch.h"
#include "libvox/subdivide/sizes.h"

#include <span>

namespace vox {

// When a vertex is fine enough for vertex conversion: every face around it, at its own level, has
// an L-inf diameter of at most kVertexConversionSpan. The diameter, not only edges and one
// diagonal: where the other corners of a face go on to deeper levels, their descendants stay in its
// convex hull, so whatever faces stitch the levels together fit into a voxel too. All lengths in
// voxels. Source: paper section 5; DESIGN sections 8 and 9.

/// L-inf size of a face that vertex conversion accepts. The guarantee holds up to 1; the rest is
/// for rounding.
inline constexpr double kVertexConversionSpan = 0.999;

/// L-inf diameter of some points: the longest side of their box. Not of an empty set.
inline double diameter(std::span<const Vec3d> points) {
  Vec3d low = points[0];
  Vec3d high = points[0];
  for (const Vec3d& point : points.subspan(1)) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  return (high - low).maxCoeff();
}

/// The same of a quad.
inline double diameter(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& d) {
  const Vec3d low = a.cwiseMin(b).cwiseMin(c.cwiseMin(d));
  const Vec3d high = a.cwiseMax(b).cwiseMax(c.cwiseMax(d));
  return (high - low).maxCoeff();
}

/// The C(n) of DESIGN section 8 for a face of n sides: faces k levels down measure at most 2^-k
/// times the largest diameter around a vertex, times the largest C around it.
double contraction(std::size_t sides);

/// Whether all four children of an irregular vertex are fine enough, from the largest diameter and
/// the largest contraction of the faces around it, none of them a strip face.
bool childrenFineEnough(double largestDiameter, double largestContraction);

/// How many levels deep all descendants of a regular vertex are fine enough; 0 if it is so itself.
/// Differences between neighbours are halved by every level and averaged, so that all faces k
/// levels down measure at most 2^-k (max |du| + max |dv|), along each axis by itself.
int patchDepth(const Patch& patch);

/// Levels for a vertex of the boundary curve of an extended surface, from the largest diameter of
/// the strip faces it belongs to. A safe bound for strips of any number of sides: they shrink by
/// less than 3 / 2^k (DESIGN section 8), as halves of faces of at most twice their size.
int curveDepth(double stripDiameter);

}  // namespace vox
