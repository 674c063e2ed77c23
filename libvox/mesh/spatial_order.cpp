// Z-order, and a measure of the order of a mesh.

#include "libvox/mesh/spatial_order.h"

#include "libvox/core/parallel.h"

#include <algorithm>
#include <cstdint>
#include <utility>

namespace vox {
namespace {

/// The 21 bits of x, with two zero bits after each.
std::uint64_t spread(std::uint64_t x) {
  x = (x | x << 32U) & 0x001F00000000FFFFULL;
  x = (x | x << 16U) & 0x001F0000FF0000FFULL;
  x = (x | x << 8U) & 0x100F00F00F00F00FULL;
  x = (x | x << 4U) & 0x10C30C30C30C30C3ULL;
  return (x | x << 2U) & 0x1249249249249249ULL;
}

Index distance(Index a, Index b) {
  return a < b ? b - a : a - b;
}

}  // namespace

std::vector<Index> spatialOrder(std::span<const Vec3d> points) {
  if (points.empty()) return {};
  constexpr double kMost = (1 << 21) - 1;
  Vec3d low = points[0];
  Vec3d high = points[0];
  for (const Vec3d& point : points) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  const double scale = kMost / std::max((high - low).maxCoeff(), 1e-300);
  std::vector<std::pair<std::uint64_t, Index>> codes(points.size());
  parallelForEach(static_cast<Index>(points.size()), kElementsPerTask, [&](Index v) {
    const Vec3d at = (points[v] - low) * scale;
    const auto along = [&](int axis) { return spread(static_cast<std::uint64_t>(at[axis])); };
    codes[v] = {along(0) << 2U | along(1) << 1U | along(2), v};
  });
  parallelSort(codes);
  std::vector<Index> order(points.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = codes[i].second;
  return order;
}

bool isScattered(const PolygonMesh& mesh) {
  constexpr Index kLarge = 1 << 16;  // smaller ones fit in a cache
  constexpr double kFar = 1.0 / 16;  // of all points, on average
  if (mesh.faceCount() < kLarge) return false;
  const auto sumOf = [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (auto f = static_cast<Index>(begin); f < end; ++f) {
      const std::span<const Index> face = mesh.face(f);
      const Index next = f + 1 == mesh.faceCount() ? face[0] : mesh.face(f + 1)[0];
      sum += std::max(distance(face[0], face[1]), distance(face[0], next));
    }
    return sum;
  };
  const double sum = parallelSum(mesh.faceCount(), kElementsPerTask, 0.0, sumOf);
  return sum / mesh.faceCount() > kFar * mesh.pointCount();
}

}  // namespace vox
