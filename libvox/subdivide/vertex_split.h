#pragma once

#include "libvox/mesh/patch.h"
#include "libvox/subdivide/stop.h"

namespace vox {

// clang-format off
/// One Doo-Sabin step at a vertex of a level >= 1: image vertices in the four faces around it. The
/// vertex is corner i of an n-gon F, its F-face. R and L are the two E-faces at the vertex. Seen
/// from outside:
///
///   F(i-1) ------ F ------ F(i+1)
///      |          |          |
///      |    L     i    R     |
///      |          |          |
///    l[2] ---- l[3] r[3] -- r[2]
///             V-face
///
/// Images in F: f0 at i, fNext at i+1, fPrevious at i-1, and fOpposite if F is a quad.
/// In the quad R across the edge i, i+1: r[0] at i, r[1] at i+1, then on around.
/// In the quad L across the edge i-1, i: l[0] at i, l[1] at i-1, then on around.
/// In the V-face: vFace0 at i, vFaceRight and vFaceLeft at its neighbours in R and L, and
/// vFaceOpposite if the V-face is a quad.
///
/// In patches, F lies at u+, v+; the V-face at u-, v-; R at u+, v-; L at u-, v+.
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

  /// Set the images in F and in the V-face if these are quads: from i on, first towards R.
  void setF(const std::array<Vec3d, 4>& images) {
    f0 = images[0], fNext = images[1], fOpposite = images[2], fPrevious = images[3];
  }
  void setVFace(const std::array<Vec3d, 4>& images) {
    vFace0 = images[0], vFaceRight = images[1], vFaceOpposite = images[2], vFaceLeft = images[3];
  }

  /// The patches of the children. Those in R and L are always regular; the one in F if F is a quad,
  /// the one in the V-face if this is a quad.
  Patch childInR() const;
  Patch childInL() const;
  Patch childInF() const;
  Patch childInVFace() const;

  /// Gives the sink the children in R and L, vertices of `level`, as far as they exist.
  void emitSides(int level, SurfaceSink& sink) const;
  /// Gives the sink the child in F. Precondition: F is a quad.
  void emitInF(int level, SurfaceSink& sink) const;
  /// Gives the sink the child in the V-face, if that exists. Precondition: it is a quad.
  void emitInVFace(int level, SurfaceSink& sink) const;
};

/// Gives the sink the descendants of a regular vertex of `level`: as a point, as a patch or, for
/// thin parts of it, as some rows and the two outermost columns (ThinPatch).
void emitRegular(const Patch& patch, int level, SurfaceSink& sink);

}  // namespace vox
