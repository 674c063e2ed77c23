// An extraordinary face and the points around it, level by level.

#include "libvox/subdivide/extraordinary_levels.h"

#include <utility>

namespace vox {
namespace {

/// One step at all corners at once.
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

void ExtraordinaryLevels::start(ExtraordinaryFace face) {
  levels_.clear();
  addLevel(std::move(face));
}

const ExtraordinaryLevels::Level& ExtraordinaryLevels::level(int l) {
  while (static_cast<int>(levels_.size()) <= l) {
    requireLevelInRange(static_cast<int>(levels_.size()));
    addLevel(below(levels_.back().face, images_));
  }
  return levels_[static_cast<std::size_t>(l)];
}

void ExtraordinaryLevels::addLevel(ExtraordinaryFace face) {
  const FaceShape shape = shapeOf(face.inner, face.real);
  levels_.push_back({std::move(face), shape});
}

}  // namespace vox
