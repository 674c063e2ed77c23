// Level 2 in the V-faces of a submesh.

#include "libvox/subdivide/v_face_level.h"

#include "libvox/subdivide/stop.h"

#include <algorithm>

namespace vox {

void VFaceLevel::reset(const LocalImages& images) {
  const std::size_t points = images.vFacePoints().size();
  known_.assign(images.vFaces().size(), false);
  diameters_.resize(images.vFaces().size());
  active_.assign(points, false);
  for (auto* of : {&points_, &near_, &far_, &corner_}) of->resize(points);
}

std::span<const Vec3d> VFaceLevel::points(const LocalImages& images, Index number) {
  const LocalImages::VFace& vFace = images.vFaces()[number];
  const auto points = std::span(points_).subspan(vFace.begin, vFace.size);
  if (!known_[number]) {
    faceImages_.of(std::span(images.vFacePoints()).subspan(vFace.begin, vFace.size), points);
    diameters_[number] = vox::diameter(points);
    known_[number] = true;
  }
  return points;
}

void VFaceLevel::setImages(const LocalImages& images, const SlotCorner& at, VertexSplit& split) {
  split.hasVFace = images.hasVFace(at.slot());
  if (!split.hasVFace) return;
  const LocalImages::VFace& vFace = images.vFace(at.slot());
  if (vFace.size == 1)
    return TriangleImages(images.image(at.slot()), vFace.mStart, vFace.mEnd).setVFace(split);
  points(images, images.vFaceNumber(at.slot()));
  const Index place = images.placeInVFace(at.slot());
  split.vFace0 = points_[vFace.begin + place];
  split.vFaceRight = points_[vFace.before(place)];
  split.vFaceLeft = points_[vFace.after(place)];
  if (vFace.size == 4) split.vFaceOpposite = points_[vFace.begin + (place ^ 2U)];
}

void VFaceLevel::join(const LocalImages& images, const SlotCorner& at, const VertexSplit& split) {
  const LocalImages::VFace& vFace = images.vFace(at.slot());
  const Index place = images.placeInVFace(at.slot());
  const Index i = vFace.begin + place;
  const Index j = vFace.before(place);
  near_[i] = split.l[0];
  far_[i] = split.l[3];
  near_[j] = split.r[3];
  far_[j] = split.r[0];
  corner_[i] = split.f0;
  active_[i] = true;
}

bool VFaceLevel::get(const LocalImages::VFace& vFace, ExtraordinaryFace& face) const {
  const auto copy = [&](const auto& all, auto& part) {
    const auto begin = all.begin() + static_cast<std::ptrdiff_t>(vFace.begin);
    part.assign(begin, begin + static_cast<std::ptrdiff_t>(vFace.size));
  };
  const auto begin = active_.begin() + static_cast<std::ptrdiff_t>(vFace.begin);
  if (std::find(begin, begin + static_cast<std::ptrdiff_t>(vFace.size), true) ==
      begin + static_cast<std::ptrdiff_t>(vFace.size))
    return false;
  face.reset(vFace.size);
  copy(active_, face.active);
  copy(points_, face.inner);
  copy(near_, face.near);
  copy(far_, face.far);
  copy(corner_, face.corner);
  face.real = vFace.fan;
  return true;
}

}  // namespace vox
