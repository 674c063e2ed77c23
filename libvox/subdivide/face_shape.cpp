// Size, flatness and direction of a face.

#include "libvox/subdivide/face_shape.h"

#include "libvox/mesh/chaikin.h"
#include "libvox/subdivide/stop.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace vox {
namespace {

/// Diameter of the real corners and the two midpoints at which the real half of the polygon ends.
double realDiameter(std::span<const Vec3d> corners, std::size_t real) {
  Vec3d low = middle(corners.front(), corners.back());
  Vec3d high = low;
  const auto add = [&](const Vec3d& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  };
  if (real < corners.size()) add(middle(corners[real - 1], corners[real]));
  for (const Vec3d& corner : corners.first(real)) add(corner);
  return (high - low).maxCoeff();
}

Vec3d unitOrZero(const Vec3d& vector) {
  const Vec3d unit = vector.stableNormalized();
  return unit.squaredNorm() > 0.5 ? unit : Vec3d::Zero();
}

}  // namespace

double faceDiameter(std::span<const Vec3d> corners, std::size_t real) {
  return real < corners.size() ? realDiameter(corners, real) : diameter(corners);
}

FaceShape shapeOf(std::span<const Vec3d> corners, std::size_t real) {
  FaceShape shape;
  shape.diameter = faceDiameter(corners, real);
  Vec3d twiceArea = Vec3d::Zero();
  shape.centroid = corners[0];
  for (std::size_t i = 1; i < corners.size(); ++i) {
    shape.centroid += corners[i];
    twiceArea += (corners[i - 1] - corners[0]).cross(corners[i] - corners[0]);
  }
  shape.centroid /= static_cast<double>(corners.size());
  shape.normal = unitOrZero(twiceArea);
  for (const Vec3d& corner : corners)
    shape.height = std::max(shape.height, std::abs(shape.normal.dot(corner - shape.centroid)));
  return shape;
}

Vec3d normalOf(const Vec3d& alongU, const Vec3d& alongV) {
  return unitOrZero(alongU.cross(alongV));
}

double angleBetween(const Vec3d& a, const Vec3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b)) * (180 / std::numbers::pi) *
         (a.isZero() || b.isZero() ? 0 : 1);
}

}  // namespace vox
