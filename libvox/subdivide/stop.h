#pragma once

#include "libvox/mesh/patch.h"

#include <span>

namespace vox {

// When a vertex is fine enough for vertex conversion: every face around it, at its own level, has
// an L-inf diameter of at most kVertexConversionSpan. The diameter, not only edges and one
// diagonal: where the other corners of a face go on to deeper levels, their descendants stay in its
// convex hull, so whatever faces stitch the levels together fit into a voxel too. All lengths in
// voxels. Source: paper section 5; DESIGN sections 5 and 6.

/// L-inf size of a face that vertex conversion accepts. The guarantee holds up to 1; the rest is
/// for rounding.
inline constexpr double kVertexConversionSpan = 0.999;

/// L-inf diameter of some points: the longest side of their box. Not of an empty set.
double diameter(std::span<const Vec3d> points);

/// Levels below a regular vertex at which every descendant is fine enough; 0 if it is so itself.
/// Differences between neighbours are halved by every level and averaged, so that all faces k
/// levels down measure at most 2^-k (max |du| + max |dv|), along each axis by itself.
int patchDepth(const Patch& patch);

/// The same for a vertex of the boundary curve of an extended surface, from the largest diameter of
/// the strip faces it belongs to. A safe bound for strips of any number of sides: they shrink by
/// less than 3 / 2^k (DESIGN section 5), as halves of faces of at most twice their size.
int curveDepth(double stripDiameter);

}  // namespace vox
