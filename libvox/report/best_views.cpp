// Views that show what differs.

#include "libvox/report/best_views.h"

#include "libvox/core/parallel.h"
#include "libvox/render/ray_cast.h"
#include "libvox/report/sample_voxels.h"

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace vox {
namespace {

/// From above and below the corners of a cube, which show three sides, then from the sides.
std::vector<View> candidates() {
  const View corner = *viewNamed("iso");
  constexpr double kQuarter = 90;
  std::vector<View> views;
  for (const double elevation : {corner.elevation, -corner.elevation})
    for (const int quarter : {0, 3, 1, 2})
      views.push_back({std::fmod(corner.azimuth + kQuarter * quarter, 4 * kQuarter), elevation});
  for (const char* side : {"front", "right", "back", "left", "top", "bottom"})
    views.push_back(*viewNamed(side));
  return views;
}

/// Which of the voxels can be seen from outside.
std::vector<bool> seenFrom(const View& view, UpAxis up, const std::vector<openvdb::Coord>& voxels,
                           RayCaster& surface, const openvdb::math::MapBase& toWorld) {
  const Vec3d forward = axesOf(view, up).forward;
  const openvdb::Vec3d index =
      toWorld.applyInverseJacobian(openvdb::Vec3d(forward.x(), forward.y(), forward.z()));
  const Vec3d back = -Vec3d(index[0], index[1], index[2]).normalized();
  constexpr double kOutOfVoxel = 0.9;  // half the diagonal of a voxel, and a little
  std::vector<bool> seen;
  for (const openvdb::Coord& voxel : voxels) {
    const openvdb::Vec3d centre = voxel.asVec3d();
    seen.push_back(
        !surface.firstHit(indexRay(Vec3d(centre[0], centre[1], centre[2]), back, kOutOfVoxel)));
  }
  return seen;
}

}  // namespace

std::vector<View> bestViews(const openvdb::MaskTree& wanted, const openvdb::MaskTree& all,
                            const openvdb::math::Transform& toWorld, UpAxis up) {
  constexpr std::uint64_t kSample = 2000;
  const std::vector<openvdb::Coord> voxels = sampleVoxels(wanted, kSample);
  const auto surface = voxelCaster(all);
  const std::vector<View> views = candidates();
  std::vector<std::vector<bool>> seen(views.size());
  parallelForEach(views.size(), 1, [&](std::size_t i) {
    seen[i] = seenFrom(views[i], up, voxels, *surface->copy(), *toWorld.baseMap());
  });
  const auto score = [&](std::size_t i) {
    return std::count(seen[i].begin(), seen[i].end(), true);
  };
  std::size_t best = 0;
  for (std::size_t i = 1; i < views.size(); ++i)
    if (score(i) > score(best)) best = i;

  constexpr double kOtherSide = 0.5;  // cosine of 60 degrees
  const Vec3d first = axesOf(views[best], up).forward;
  std::size_t second = best;
  std::ptrdiff_t most = -1;
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (axesOf(views[i], up).forward.dot(first) > kOtherSide) continue;
    std::ptrdiff_t added = 0;
    for (std::size_t k = 0; k < voxels.size(); ++k) added += seen[i][k] && !seen[best][k] ? 1 : 0;
    if (added > most) {
      most = added;
      second = i;
    }
  }
  return {views[best], views[second]};
}

}  // namespace vox
