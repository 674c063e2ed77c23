// Winding numbers by crossings of rays along +x, for all voxels of a column at once.

#include "libvox/volume/winding.h"

#include "libvox/core/parallel.h"
#include "libvox/grid/openvdb.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>

namespace vox {
namespace {

using openvdb::Coord;
constexpr std::size_t kFacesPerTask = 256;

/// Voxels sorted by columns along x.
class Columns {
 public:
  explicit Columns(std::span<const Coord> voxels) : voxels_(voxels), order_(voxels.size()) {
    std::iota(order_.begin(), order_.end(), std::size_t{0});
    std::sort(order_.begin(), order_.end(),
              [&](std::size_t a, std::size_t b) { return key(voxels[a]) < key(voxels[b]); });
  }

  /// Calls visit(voxel number) for the voxels with this y, z in [lowZ, highZ].
  template <class Visit>
  void forRow(int y, int lowZ, int highZ, Visit&& visit) const {
    const auto before = [&](std::size_t i, const std::pair<int, int>& at) {
      return std::pair(voxels_[i].y(), voxels_[i].z()) < at;
    };
    auto at = std::lower_bound(order_.begin(), order_.end(), std::pair(y, lowZ), before);
    for (; at != order_.end() && voxels_[*at].y() == y && voxels_[*at].z() <= highZ; ++at)
      visit(*at);
  }

 private:
  static std::tuple<int, int, int> key(const Coord& voxel) {
    return {voxel.y(), voxel.z(), voxel.x()};
  }

  std::span<const Coord> voxels_;
  std::vector<std::size_t> order_;
};

/// Whether, in the projection along x, the ray from p in +z crosses edge ab. The interval of y of
/// the edge is half open. ab and ba give the same answer, so no ray slips between neighbouring
/// triangles.
bool crossesAbove(const Vec3d* a, const Vec3d* b, const Vec3d& p) {
  if ((a->y() > p.y()) == (b->y() > p.y())) return false;
  if (a->y() > b->y()) std::swap(a, b);
  return (b->y() - a->y()) * (p.z() - a->z()) - (p.y() - a->y()) * (b->z() - a->z()) < 0;
}

/// Contribution of a triangle to the winding number of p: -1, 0 or 1.
int crossing(const Vec3d& a, const Vec3d& b, const Vec3d& c, const Vec3d& p) {
  if (!(crossesAbove(&a, &b, p) ^ crossesAbove(&b, &c, p) ^ crossesAbove(&c, &a, p))) return 0;
  const Vec3d ab = b - a;
  const Vec3d ac = c - a;
  const Vec3d normal(ab.y() * ac.z() - ab.z() * ac.y(), ab.z() * ac.x() - ab.x() * ac.z(),
                     ab.x() * ac.y() - ab.y() * ac.x());
  const double toPlane = normal.dot(Vec3d(a - p));
  if (normal.x() > 0) return toPlane > 0 ? 1 : 0;
  return toPlane < 0 ? -1 : 0;
}

}  // namespace

std::vector<int> windingNumbers(const PolygonMesh& surfaces, std::span<const Coord> voxels) {
  const Columns columns(voxels);
  std::vector<std::atomic<int>> windings(voxels.size());
  const auto addTriangle = [&](const Vec3d& a, const Vec3d& b, const Vec3d& c) {
    const auto [lowY, highY] = std::minmax({a.y(), b.y(), c.y()});
    const auto [lowZ, highZ] = std::minmax({a.z(), b.z(), c.z()});
    for (int y = static_cast<int>(std::ceil(lowY)); y <= highY; ++y)
      columns.forRow(y, static_cast<int>(std::ceil(lowZ)), static_cast<int>(std::floor(highZ)),
                     [&](std::size_t i) {
                       const Coord& at = voxels[i];
                       const int sign = crossing(a, b, c, Vec3d(at.x(), at.y(), at.z()));
                       if (sign != 0) windings[i].fetch_add(sign, std::memory_order_relaxed);
                     });
  };
  parallelForEach(surfaces.faceCount(), kFacesPerTask, [&](Index f) {
    const auto face = surfaces.face(f);
    const auto& points = surfaces.points;
    addTriangle(points[face[0]], points[face[1]], points[face[2]]);
    if (face.size() > 3) addTriangle(points[face[0]], points[face[2]], points[face[3]]);
  });
  return {windings.begin(), windings.end()};
}

}  // namespace vox
