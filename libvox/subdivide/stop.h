#pragma once

#include "libvox/subdivide/doo_sabin.h"

#include <span>
#include <vector>

namespace vox {

/// L-inf size of a face as the vertex-conversion guarantee needs it: the longest edge, in the
/// L-inf norm, of a triangulation of the face. Triangle and n-gon: the L-inf diameter (longest side
/// of the bounding box). Quad: the four edges and the better of its two diagonals.
/// Unit: that of the points. Source: paper section 5; DESIGN section 6.
double faceSpan(std::span<const Vec3d> corners);

/// Largest faceSpan over the faces of the next level, computed from this level and the next level's
/// points, without building the faces. Parallel; result independent of thread count.
double largestChildSpan(const SubdivisionLevel& level, const std::vector<Vec3d>& image);

}  // namespace vox
