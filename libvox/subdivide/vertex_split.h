#pragma once

#include "libvox/mesh/patch.h"
#include "libvox/subdivide/stop.h"

namespace vox {

// clang-format off
/// One Doo-Sabin step at a vertex i of an n-gon F. At a level-1 vertex F is its F-face, R and L are
/// its E-faces. Seen from outside:
///
///   F(i-1) ------ F ------ F(i+1)
///      |          |          |
///      |    L     i    R     |
///      |          |          |
///    l[2] ---- l[3] r[3] -- r[2]
///             V-face
///
/// Images in the face F: f0 at i, fNext at i+1, fPrevious at i-1, and fOpposite if F is a quad. In the
/// quad R across the edge i, i+1: r[0] at i, r[1] at i+1, then on around. In the quad L across the edge
/// i-1, i: l[0] at i, l[1] at i-1, then on around. In the V-face, opposite F: vFace0 at i, vFaceRight
/// and vFaceLeft at its neighbours in R and L, and vFaceOpposite if the V-face is a quad.
///
/// F is where u and v grow, the V-face where both fall; R lies at u+, v-, and L at u-, v+.
// clang-format on
struct VertexSplit {
  Vec3d f0, fNext, fPrevious;
  Vec3d fOpposite = Vec3d::Zero();
  std::array<Vec3d, 4> r;
  std::array<Vec3d, 4> l;
  Vec3d vFace0 = Vec3d::Zero(), vFaceRight = Vec3d::Zero(), vFaceOpposite = Vec3d::Zero();
  Vec3d vFaceLeft = Vec3d::Zero();
  // At a free boundary some of the faces do not exist. F always does.
  bool hasR = true;
  bool hasL = true;
  bool hasVFace = true;

  /// F and the V-face as quads, their images in order from i, first towards R.
  void setF(const std::array<Vec3d, 4>& images) {
    f0 = images[0], fNext = images[1], fOpposite = images[2], fPrevious = images[3];
  }
  void setVFace(const std::array<Vec3d, 4>& images) {
    vFace0 = images[0], vFaceRight = images[1], vFaceOpposite = images[2], vFaceLeft = images[3];
  }

  /// The children, as far as all their faces are quads: those in R and L, the one in F and the one
  /// in the V-face where these are quads.
  Patch childInR() const;
  Patch childInL() const;
  Patch childInF() const;
  Patch childInVFace() const;

  /// Gives the sink the children in R and L, whose faces are quads, at `level`.
  void emitSides(int level, SurfaceSink& sink) const;
  /// The child in F, when F is a quad.
  void emitInF(int level, SurfaceSink& sink) const;
  /// The child in the V-face, when that is a quad.
  void emitInVFace(int level, SurfaceSink& sink) const;
};

/// Gives a regular vertex of `level` to the sink, at its depth: as a point, as a patch, or, where
/// it is thin, as the rows that do for it and the two outermost columns.
void emitRegular(const Patch& patch, int level, SurfaceSink& sink);

}  // namespace vox
