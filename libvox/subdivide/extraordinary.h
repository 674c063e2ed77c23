#pragma once

#include "libvox/mesh/patch.h"
#include "libvox/subdivide/face_images.h"
#include "libvox/subdivide/vertex_split.h"

#include <span>
#include <vector>

namespace vox {

/// An n-gon of level >= 1 whose neighbours are all quads, and what lies around it. Where a vertex i
/// is `active`, the surface below it is wanted.
///
///   inner[i]   the corners of the n-gon, counter-clockwise
///   near[i]    across the edge i, i+1: the point next to corner i
///   far[i]     across the edge i, i+1: the point next to corner i+1
///   corner[i]  the point opposite corner i in the quad that only touches it
///
/// An open fan of m faces ends at the boundary with half of a 2m-gon; then n = 2m, the last m
/// corners are the mirror images of the first m (`real` = m), and so are the points across the two
/// edges between them. The step for strip faces of DESIGN section 4 is the plain one on this
/// polygon.
struct ExtraordinaryFace {
  std::vector<Vec3d> inner, near, far, corner;
  std::vector<std::uint8_t> active;
  std::vector<std::uint8_t> hasEdge;    ///< is there a face across the edge i, i+1
  std::vector<std::uint8_t> hasCorner;  ///< is there a face that only touches corner i
  std::size_t real = 0;                 ///< corners that are not mirror images

  /// All slots for an n-gon, none active, with faces all around.
  void reset(std::size_t n);

  std::size_t before(std::size_t i) const { return (i == 0 ? inner.size() : i) - 1; }
  std::size_t after(std::size_t i) const { return i + 1 == inner.size() ? 0 : i + 1; }
  /// Where the polygon is mirrored, its real half ends at the middle of two edges.
  bool mirrored() const { return real < inner.size(); }
  /// One step at corner i, with the polygon as F; `images` are those of the polygon.
  VertexSplit splitAt(std::span<const Vec3d> images, std::size_t i) const;
};

/// Bound of the levels below an extraordinary face: sizes halve, from 2^32 voxels at most.
/// @throws LimitError  level is beyond it
void requireLevelInRange(int level);

/// Subdivides the active vertices of an extraordinary face of `level`, each until it is fine
/// enough. Every level is one O(n) step, which gives off three regular vertices for each active one
/// and leaves the same situation at half the size.
class ExtraordinarySubdivision {
 public:
  /// @throws LimitError  a face that does not become small: coordinates beyond all range
  void run(ExtraordinaryFace& face, int level, SurfaceSink& sink);

 private:
  FaceImages images_;
  ExtraordinaryFace next_;
  std::vector<Vec3d> finished_;
  std::vector<Vec3d> finishedChildren_;
  std::vector<Vec3d> innerImages_;
  std::vector<Vec3d> work_;
};

/// The corner of a boundary vertex with one face: u has the triangle T = [u, mEnd, mStart] on the
/// boundary, strips R = [right, u, mStart, mRight] and L = [u, left, mLeft, mEnd] beside it, and
/// the quad [u, right, opposite, left] behind it.
struct BoundaryCorner {
  Vec3d u, mStart, mEnd, right, mRight, left, mLeft, opposite;

  /// One step, with the quad as F and T as the V-face: of T only the images next to u
  /// are known.
  VertexSplit split() const;
  /// The same corner one level down, where it is the child of the V-face.
  BoundaryCorner below(const VertexSplit& split) const;
};

/// Images of T (m = 1 in DESIGN section 4): u' = u/2 + (mStart + mEnd)/4, and Chaikin points.
struct TriangleImages {
  Vec3d u, mStart, mEnd;
  TriangleImages(const Vec3d& u, const Vec3d& mStart, const Vec3d& mEnd);
  /// T as the V-face of u, with the mirror images of its child beyond the boundary.
  void setVFace(VertexSplit& split) const;
};

/// Subdivides u, a vertex of `level`, until it is fine enough.
/// @throws LimitError  as ExtraordinarySubdivision
void subdivideBoundaryCorner(BoundaryCorner corner, int level, SurfaceSink& sink);

}  // namespace vox
