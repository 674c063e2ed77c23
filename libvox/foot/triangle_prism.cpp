// Prisms around triangles.

#include "libvox/foot/triangle_prism.h"

#include <algorithm>
#include <cmath>

namespace vox {

TriangleFrame::TriangleFrame(const std::array<Vec3d, 3>& points, const Vec3d& normal) {
  Vec3d longest = Vec3d::Zero();
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3d side = points[(i + 1) % 3] - points[i];
    if (side.squaredNorm() > longest.squaredNorm()) longest = side;
  }
  Vec3d along = longest - longest.dot(normal) * normal;
  if (!(along.squaredNorm() > 0)) along = normal.unitOrthogonal();
  along.normalize();
  axes = {along, normal.cross(along), normal};
}

Prism prismAround(const std::array<Vec3d, 3>& points, const openvdb::Coord& origin,
                  const TriangleFrame& frame, const std::array<double, 3>& margins) {
  Prism prism;
  prism.origin = origin;
  Vec3d centre = Vec3d::Zero();
  for (std::size_t k = 0; k < 3; ++k) {
    const Vec3d& axis = frame.axes[k];
    const auto [low, high] =
        std::minmax({axis.dot(points[0]), axis.dot(points[1]), axis.dot(points[2])});
    centre += (low + high) / 2 * axis;
    prism.normals[k] = asFloats(axis / ((high - low) / 2 + margins[k]));
  }
  prism.centre = asFloats(centre);
  for (int x = 0; x < 3; ++x) {
    double margin = 0;
    for (std::size_t k = 0; k < 3; ++k) margin += margins[k] * std::abs(frame.axes[k][x]);
    const auto [low, high] = std::minmax({points[0][x], points[1][x], points[2][x]});
    prism.box.min()[x] = origin[x] + static_cast<int>(std::ceil(low - margin));
    prism.box.max()[x] = origin[x] + static_cast<int>(std::floor(high + margin));
  }
  return prism;
}

}  // namespace vox
