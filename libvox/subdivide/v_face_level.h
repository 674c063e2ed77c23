#pragma once

#include "libvox/subdivide/extraordinary.h"
#include "libvox/subdivide/local_images.h"
#include "libvox/subdivide/vertex_split.h"

#include <cstdint>
#include <span>
#include <vector>

namespace vox {

/// Level 2 in the V-faces of a submesh: their points, made when first asked for, and what lies
/// around the corners that a walk subdivides further. One object per thread.
class VFaceLevel {
 public:
  /// Forgets the last submesh.
  void reset(const LocalImages& images);

  /// The points in a V-face of more than one corner.
  /// @param number  of the V-face (LocalImages)
  std::span<const Vec3d> points(const LocalImages& images, Index number);
  /// L-inf diameter of the points; valid once these are known.
  double diameter(Index number) const { return diameters_[number]; }

  /// Sets the images in the V-face, if there is one, of the step at a level-1 vertex.
  void setImages(const LocalImages& images, const SlotCorner& at, VertexSplit& split);

  /// Makes a corner an active corner of its V-face. In the V-face the next corner lies across L.
  void join(const LocalImages& images, const SlotCorner& at, const VertexSplit& split);

  /// Sets `face` to a V-face with its active corners.
  /// @return false, and no face, if it has none
  bool get(const LocalImages::VFace& vFace, ExtraordinaryFace& face) const;

 private:
  std::vector<Vec3d> points_;               // per point of a V-face, as the next four
  std::vector<Vec3d> near_, far_, corner_;  // as in ExtraordinaryFace
  std::vector<std::uint8_t> active_;
  std::vector<double> diameters_;  // per V-face
  std::vector<std::uint8_t> known_;
  FaceImages faceImages_;
};

}  // namespace vox
