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

/// The frame in which a polygon is judged.
struct Frame {
  Vec3d mean, normal;
  double least;  ///< twice the area that a triangle must have
  bool hasArea;
};

Frame frameOf(std::span<const Vec3d> corners) {
  Vec3d mean = Vec3d::Zero();  // from corner 0: exact enough far from the origin
  for (const Vec3d& corner : corners) mean += corner - corners[0];
  mean = corners[0] + mean / static_cast<double>(corners.size());
  double size = 0;
  for (const Vec3d& corner : corners) size = std::max(size, (corner - mean).stableNorm());
  const Vec3d area = twiceAreaVector(corners);
  const bool hasArea = area.stableNorm() > kNoStarArea * size * size;
  return {mean, area.stableNormalized(), -kStarTolerance * size * size, hasArea};
}

}  // namespace

bool isStarShaped(std::span<const Vec3d> corners) {
  const std::size_t n = corners.size();
  if (n <= 3) return true;
  const Frame frame = frameOf(corners);
  if (!frame.hasArea) return true;
  Vec3d from = corners[n - 1] - frame.mean;
  for (const Vec3d& corner : corners) {
    const Vec3d to = corner - frame.mean;
    if (from.cross(to).dot(frame.normal) < frame.least) return false;
    from = to;
  }
  return true;
}

bool isConvex(std::span<const Vec3d> corners) {
  const std::size_t n = corners.size();
  if (n <= 3 || !isStarShaped(corners)) return n <= 3;
  const Frame frame = frameOf(corners);
  if (!frame.hasArea) return true;
  for (std::size_t i = 0; i < n; ++i) {
    const Vec3d arriving = corners[i] - corners[(i + n - 1) % n];
    const Vec3d leaving = corners[(i + 1) % n] - corners[i];
    if (arriving.cross(leaving).dot(frame.normal) < frame.least) return false;
  }
  return true;
}

}  // namespace vox
