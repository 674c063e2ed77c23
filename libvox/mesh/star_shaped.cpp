// About the mean of the corners.

#include "libvox/mesh/star_shaped.h"

#include "libvox/mesh/flat_polygon.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cstddef>

namespace vox {
namespace {

constexpr double kStarTolerance = 1e-9;
constexpr double kNoStarArea = 1e-12;  // of the square of the size

}  // namespace

bool isStarShaped(std::span<const Vec3d> corners) {
  const std::size_t n = corners.size();
  if (n <= 3) return true;
  Vec3d mean = Vec3d::Zero();  // from corner 0: exact enough far from the origin
  for (const Vec3d& corner : corners) mean += corner - corners[0];
  mean = corners[0] + mean / static_cast<double>(n);
  double size = 0;
  for (const Vec3d& corner : corners) size = std::max(size, (corner - mean).stableNorm());
  const Vec3d area = twiceAreaVector(corners);
  if (!(area.stableNorm() > kNoStarArea * size * size)) return true;
  const Vec3d normal = area.stableNormalized();
  const double least = -kStarTolerance * size * size;
  Vec3d from = corners[n - 1] - mean;
  for (const Vec3d& corner : corners) {
    const Vec3d to = corner - mean;
    if (from.cross(to).dot(normal) < least) return false;
    from = to;
  }
  return true;
}

}  // namespace vox
