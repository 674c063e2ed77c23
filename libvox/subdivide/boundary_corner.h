#pragma once

#include "libvox/mesh/patch.h"
#include "libvox/subdivide/vertex_split.h"

namespace vox {

/// The vertex u of level >= 2 in the triangle T that a boundary vertex with one face makes. The
/// faces around u are T = [u, mEnd, mStart], with its edge mEnd, mStart on the boundary; the strips
/// R = [right, u, mStart, mRight] and L = [u, left, mLeft, mEnd]; and the quad
/// [u, right, opposite, left].
struct BoundaryCorner {
  Vec3d u, mStart, mEnd, right, mRight, left, mLeft, opposite;

  /// The patch around u, with mirrored strips. T stands in the place of the V-face: its corner
  /// opposite u is u.
  Patch around() const;
  /// One step at u. In the figure of vertex_split.h, F is the quad, and T stands in the place of
  /// the V-face; of its images only those next to u are set.
  VertexSplit split() const;
  /// The vertex one level down in T, given split().
  BoundaryCorner below(const VertexSplit& split) const;
};

/// Images of the triangle T = [u, mEnd, mStart] (m = 1 in DESIGN section 4): u' = u/2 + (mStart +
/// mEnd)/4, and Chaikin points.
struct TriangleImages {
  Vec3d u, mStart, mEnd;
  TriangleImages(const Vec3d& u, const Vec3d& mStart, const Vec3d& mEnd);
  /// Sets the images in the V-face, with T in its place: u', and its mirror images beyond the
  /// boundary.
  void setVFace(VertexSplit& split) const;
  /// u as a vertex of level 2, given the step at the level-1 vertex with T in place of its V-face.
  BoundaryCorner below(const VertexSplit& split) const;
};

}  // namespace vox
