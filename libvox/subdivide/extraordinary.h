#pragma once

#include "libvox/mesh/patch.h"
#include "libvox/subdivide/face_images.h"
#include "libvox/subdivide/vertex_split.h"

#include <span>
#include <vector>

namespace vox {

/// An n-gon of level >= 1 whose neighbours are all quads, with the points around it. Only `active`
/// corners are to be subdivided; the surroundings of the others need not be set.
///
///   inner[i]   the corners of the n-gon, counter-clockwise
///   near[i]    across the edge i, i+1: the point next to corner i
///   far[i]     across the edge i, i+1: the point next to corner i+1
///   corner[i]  the point opposite corner i in the quad that only touches it
///
/// At the boundary, an open fan of m faces makes half of a 2m-gon. Then n = 2m, `real` = m, and the
/// last m corners are the mirror images of the first m; the points across the two edges between
/// them are mirror images, too. A plain step on this polygon is the step for strip faces of DESIGN
/// section 4.
struct ExtraordinaryFace {
  std::vector<Vec3d> inner, near, far, corner;
  std::vector<std::uint8_t> active;
  std::vector<std::uint8_t> hasEdge;    ///< whether there is a face across the edge i, i+1
  std::vector<std::uint8_t> hasCorner;  ///< whether there is a face that only touches corner i
  std::size_t real = 0;                 ///< number of corners that are not mirror images

  /// Makes room for an n-gon: all points 0, no corner active, all faces around it exist.
  void reset(std::size_t n);

  std::size_t before(std::size_t i) const { return (i == 0 ? inner.size() : i) - 1; }
  std::size_t after(std::size_t i) const { return i + 1 == inner.size() ? 0 : i + 1; }
  /// Whether the polygon has a mirrored half. The real half ends at the midpoints of two edges.
  bool mirrored() const { return real < inner.size(); }
  /// Sets the surroundings of corner i, which becomes active, from the step that makes this corner
  /// as its child in F.
  void join(std::size_t i, const VertexSplit& split);
  /// One step at corner i, with the polygon as F.
  /// @param images  image vertices of the polygon
  VertexSplit splitAt(std::span<const Vec3d> images, std::size_t i) const;
};

/// Checks a level below an extraordinary face. Sizes halve with each level, starting from at most
/// 2^32 voxels, so 64 levels are enough for all coordinates in range.
/// @throws LimitError  the level is above 64
void requireLevelInRange(int level);

/// Subdivides the active corners of an extraordinary face, each until it is fine enough. A step
/// costs O(n): it emits three regular vertices for each active corner; the fourth child is a corner
/// of an extraordinary face of half the size.
class ExtraordinarySubdivision {
 public:
  /// Gives the sink all descendants of the active corners of a face of `level`. Changes the face.
  /// @throws LimitError  the face does not become small: coordinates are out of range
  void run(ExtraordinaryFace& face, int level, SurfaceSink& sink);

 private:
  FaceImages images_;
  ExtraordinaryFace next_;
  std::vector<Vec3d> finished_;
  std::vector<Vec3d> finishedChildren_;
  std::vector<Vec3d> innerImages_;
  std::vector<Vec3d> work_;
};

/// The vertex u of level >= 2 in the triangle T that a boundary vertex with one face makes. The
/// faces around u are T = [u, mEnd, mStart], with its edge mEnd, mStart on the boundary; the strips
/// R = [right, u, mStart, mRight] and L = [u, left, mLeft, mEnd]; and the quad
/// [u, right, opposite, left].
struct BoundaryCorner {
  Vec3d u, mStart, mEnd, right, mRight, left, mLeft, opposite;

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

/// Gives the sink all descendants of u, a vertex of `level`, each at the level at which it is fine
/// enough.
/// @throws LimitError  as ExtraordinarySubdivision
void subdivideBoundaryCorner(BoundaryCorner corner, int level, SurfaceSink& sink);

}  // namespace vox
