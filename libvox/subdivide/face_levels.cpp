// A face and its images, level by level.

#include "libvox/subdivide/face_levels.h"

namespace vox {

void FaceLevels::start(std::span<const Vec3d> corners, std::size_t real) {
  size_ = corners.size();
  real_ = real;
  corners_.assign(corners.begin(), corners.end());
  shapes_.clear();
  diameters_.clear();
}

std::span<const Vec3d> FaceLevels::corners(int level) {
  const std::size_t end = static_cast<std::size_t>(level) * size_;
  while (corners_.size() < end) {
    corners_.resize(corners_.size() + size_);
    const auto last = std::span(corners_).last(2 * size_);
    images_.of(last.first(size_), last.last(size_));
  }
  return std::span(corners_).subspan(end - size_, size_);
}

const FaceShape& FaceLevels::shape(int level) {
  const auto count = static_cast<std::size_t>(level);
  while (shapes_.size() < count)
    shapes_.push_back(shapeOf(corners(static_cast<int>(shapes_.size()) + 1), real_));
  return shapes_[count - 1];
}

double FaceLevels::diameter(int level) {
  const auto count = static_cast<std::size_t>(level);
  while (diameters_.size() < count)
    diameters_.push_back(faceDiameter(corners(static_cast<int>(diameters_.size()) + 1), real_));
  return diameters_[count - 1];
}

}  // namespace vox
