#pragma once

#include "libvox/core/types.h"

#include <span>

namespace vox {

/// Measures of a face for stop rules. Lengths in the unit of its points.
struct FaceShape {
  double diameter = 0;           ///< L-inf; only of the real half of a mirrored polygon
  double height = 0;             ///< largest distance of a corner from the mean plane
  Vec3d normal = Vec3d::Zero();  ///< unit, by the area vector; 0 for a face without area
  Vec3d centroid = Vec3d::Zero();
};

/// FaceShape::diameter of a face with 3 corners or more.
/// @param real  number of corners that are not mirror images (FaceLevels)
double faceDiameter(std::span<const Vec3d> corners, std::size_t real);

/// Shape of a face with 3 corners or more.
/// @param real  number of corners that are not mirror images (FaceLevels)
FaceShape shapeOf(std::span<const Vec3d> corners, std::size_t real);
inline FaceShape shapeOf(std::span<const Vec3d> corners) {
  return shapeOf(corners, corners.size());
}

/// Unit vector along alongU x alongV; 0 if the two are parallel or one of them is 0.
Vec3d normalOf(const Vec3d& alongU, const Vec3d& alongV);

/// Angle between two unit normals, in degrees; 0 if one of them is 0.
double angleBetween(const Vec3d& a, const Vec3d& b);

}  // namespace vox
