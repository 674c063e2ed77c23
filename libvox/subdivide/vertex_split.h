#pragma once

#include "libvox/mesh/patch.h"

#include <array>
#include <cstddef>
#include <span>

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
  /// Sets the images in R and L. The others are 0 until they are set.
  /// @param around  the patch around the vertex; its corners in F and in the V-face are not used
  explicit VertexSplit(const Patch& around);

  Vec3d f0 = Vec3d::Zero(), fNext = Vec3d::Zero(), fPrevious = Vec3d::Zero();
  Vec3d fOpposite = Vec3d::Zero();
  std::array<Vec3d, 4> r, l;
  Vec3d vFace0 = Vec3d::Zero(), vFaceRight = Vec3d::Zero(), vFaceOpposite = Vec3d::Zero();
  Vec3d vFaceLeft = Vec3d::Zero();
  bool hasR, hasL, hasVFace;  ///< at a free boundary some of the faces do not exist; F always does

  /// Set the images in F and in the V-face if these are quads: from i on, first towards R.
  void setF(const std::array<Vec3d, 4>& images) {
    f0 = images[0], fNext = images[1], fOpposite = images[2], fPrevious = images[3];
  }
  void setVFace(const std::array<Vec3d, 4>& images) {
    vFace0 = images[0], vFaceRight = images[1], vFaceOpposite = images[2], vFaceLeft = images[3];
  }
  /// The same for faces of any size, of whose corners the vertex is number `place`; both faces are
  /// counter-clockwise.
  void setF(std::span<const Vec3d> images, std::size_t place);
  void setVFace(std::span<const Vec3d> images, std::size_t place);

  /// The patches of the children. Those in R and L are always regular; the one in F if F is a quad,
  /// the one in the V-face if this is a quad. Else the corner of the patch in F, or in the V-face,
  /// has no meaning.
  Patch childInR() const;
  Patch childInL() const;
  Patch childInF() const;
  Patch childInVFace() const;
};

}  // namespace vox
