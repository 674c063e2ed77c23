#pragma once

#include "libvox/core/types.h"

#include <span>

namespace vox {

/// What stop rules ask of a face. Lengths in the unit of its points.
struct FaceShape {
  double diameter = 0;           ///< L-inf; of a mirrored polygon, of its real half
  double height = 0;             ///< largest distance of a corner from the mean plane
  Vec3d normal = Vec3d::Zero();  ///< unit, by the area vector; 0 for a face without area
};

/// @param real  corners that are not mirror images (ExtraordinaryFace)
FaceShape shapeOf(std::span<const Vec3d> corners, std::size_t real);
inline FaceShape shapeOf(std::span<const Vec3d> corners) {
  return shapeOf(corners, corners.size());
}

/// Degrees between two unit normals; 0 if one is 0.
double angleBetween(const Vec3d& a, const Vec3d& b);

}  // namespace vox
