// The surroundings of an extraordinary face, level by level.

#include "libvox/subdivide/extraordinary_rings.h"

#include <utility>

namespace vox {
namespace {

/// One step at all corners.
ExtraordinaryFace below(const ExtraordinaryFace& face, FaceImages& images) {
  ExtraordinaryFace next = face;
  images.of(face.inner, next.inner);
  for (std::size_t i = 0; i < face.inner.size(); ++i) {
    const std::size_t n = face.after(i);
    const std::size_t j = face.before(i);
    next.near[i] = quadImage(face.inner[i], face.inner[n], face.near[i], face.far[i]);
    next.far[i] = quadImage(face.inner[n], face.inner[i], face.far[i], face.near[i]);
    next.corner[i] = quadImage(face.inner[i], face.near[i], face.far[j], face.corner[i]);
  }
  return next;
}

}  // namespace

void ExtraordinaryRings::start(ExtraordinaryFace face) {
  rings_.clear();
  addRing(std::move(face));
}

const ExtraordinaryRings::Ring& ExtraordinaryRings::ring(int l) {
  while (static_cast<int>(rings_.size()) <= l) {
    requireLevelInRange(static_cast<int>(rings_.size()));
    addRing(below(rings_.back().face, images_));
  }
  return rings_[static_cast<std::size_t>(l)];
}

void ExtraordinaryRings::addRing(ExtraordinaryFace face) {
  const FaceShape shape = shapeOf(face.inner, face.real);
  rings_.push_back({std::move(face), shape});
}

}  // namespace vox
