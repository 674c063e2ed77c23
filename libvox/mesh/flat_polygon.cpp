// Projection onto a lattice of 51 bits: cross products stay below 2^105.

#include "libvox/mesh/flat_polygon.h"

#include "libvox/mesh/area_vector.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>

namespace vox {
namespace {

constexpr double kLatticeReach = 1LL << 50;

}  // namespace

double squaredDistance(const FlatPoint& a, const FlatPoint& b) {
  const auto x = static_cast<double>(b.x - a.x);
  const auto y = static_cast<double>(b.y - a.y);
  return x * x + y * y;
}

Vec3d twiceAreaVector(std::span<const Vec3d> corners) {
  return twiceAreaVector(corners.size(), [&](std::size_t i) { return corners[i]; });
}

std::vector<FlatPoint> flattened(std::span<const Vec3d> positions, const Vec3d& normal) {
  Vec3d direction = normal.stableNormalized();
  if (!(direction.squaredNorm() > 0.5)) direction = Vec3d::UnitZ();
  const Vec3d right = direction.unitOrthogonal();
  const Vec3d up = direction.cross(right);
  double reach = 0;
  for (const Vec3d& position : positions)
    reach = std::max(reach, (position - positions[0]).lpNorm<Eigen::Infinity>());
  // A position projects onto a unit vector with at most sqrt(3) of its largest coordinate.
  const double scale = reach > 0 ? kLatticeReach / (2 * reach) : 0;
  std::vector<FlatPoint> flat;
  flat.reserve(positions.size());
  for (const Vec3d& position : positions) {
    const Vec3d offset = scale * (position - positions[0]);
    flat.push_back({std::llrint(right.dot(offset)), std::llrint(up.dot(offset))});
  }
  return flat;
}

}  // namespace vox
