#pragma once

#include "libvox/subdivide/face_images.h"
#include "libvox/subdivide/face_shape.h"

#include <span>
#include <vector>

namespace vox {

/// A face of level 1 and its images at the levels below, each made when first asked for, at a cost
/// of O(n). All these faces have n corners, counter-clockwise.
///
/// At the boundary, an open fan of m faces makes half of a 2m-gon. Then n = 2m, and the last m
/// corners are the mirror images of the first m. A plain step on this polygon is the step for strip
/// faces of DESIGN section 4. One object per thread; buffers are kept.
class FaceLevels {
 public:
  /// Replaces the face.
  /// @param corners  of level 1; n >= 3
  /// @param real     number of corners that are not mirror images: n or m
  void start(std::span<const Vec3d> corners, std::size_t real);
  /// Removes the face.
  void clear() { size_ = 0; }
  bool empty() const { return size_ == 0; }

  std::size_t size() const { return size_; }
  std::size_t real() const { return real_; }
  /// Whether the polygon has a mirrored half. The real half ends at the midpoints of two edges.
  bool mirrored() const { return real_ < size_; }

  /// The corners at a level. Valid until corners or shape is called for another level.
  std::span<const Vec3d> corners(int level);
  /// The shape at a level. Valid until shape is called for another level.
  const FaceShape& shape(int level);
  /// FaceShape::diameter at a level, without the rest of the shape.
  double diameter(int level);

 private:
  std::size_t size_ = 0;
  std::size_t real_ = 0;
  std::vector<Vec3d> corners_;     // level by level
  std::vector<FaceShape> shapes_;  // of the first levels
  std::vector<double> diameters_;  // the same
  FaceImages images_;
};

}  // namespace vox
