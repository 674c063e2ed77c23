// Clusters of voxels, and where to look at them closely.

#include "libvox/report/clusters.h"

#include "libvox/core/error.h"
#include "libvox/inspect/components.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace vox {
namespace {

using openvdb::Coord;
using openvdb::CoordBBox;

/// Voxels of the cluster of a voxel, breadth first.
std::vector<Coord> flood(const openvdb::MaskTree& voxels, const Coord& first, std::size_t most) {
  const openvdb::tree::ValueAccessor<const openvdb::MaskTree> at(voxels);
  std::set<Coord> seen = {first};
  std::vector<Coord> cluster = {first};
  for (std::size_t i = 0; i < cluster.size() && cluster.size() < most; ++i) {
    const Coord voxel = cluster[i];
    for (auto next = CoordBBox(voxel.offsetBy(-1), voxel.offsetBy(1)).begin(); next; ++next)
      if (at.isValueOn(*next) && seen.insert(*next).second) cluster.push_back(*next);
  }
  return cluster;
}

std::int64_t squaredDistance(const Coord& a, const Coord& b) {
  std::int64_t sum = 0;
  for (int i = 0; i < 3; ++i) sum += std::int64_t{a[i] - b[i]} * (a[i] - b[i]);
  return sum;
}

}  // namespace

std::vector<Cluster> largestClusters(const openvdb::MaskTree& voxels, std::size_t most) {
  std::vector<Component> components;
  try {
    components = activeComponents(voxels);
  } catch (const LimitError&) {  // huge tiles
    return {};
  }
  std::vector<Cluster> clusters;
  for (const Component& component : components)
    clusters.push_back(
        {component.voxels, Coord(component.first[0], component.first[1], component.first[2])});
  std::stable_sort(clusters.begin(), clusters.end(),
                   [](const Cluster& a, const Cluster& b) { return a.voxels > b.voxels; });
  clusters.resize(std::min(clusters.size(), most));
  return clusters;
}

CoordBBox closeUpBox(const openvdb::MaskTree& voxels, const Coord& first, int side) {
  constexpr std::size_t kMostVoxels = 100000;  // more than fill the surface of a close-up
  const std::vector<Coord> cluster = flood(voxels, first, kMostVoxels);
  CoordBBox box;
  for (const Coord& voxel : cluster) box.expand(voxel);
  if (box.extents()[static_cast<int>(box.maxExtent())] <= side) return box;
  const Coord middle = Coord::round(box.getCenter());
  const Coord nearest =
      *std::min_element(cluster.begin(), cluster.end(), [&](const Coord& a, const Coord& b) {
        return squaredDistance(a, middle) < squaredDistance(b, middle);
      });
  const int half = side / 2;
  return {nearest.offsetBy(-half), nearest.offsetBy(side - 1 - half)};
}

}  // namespace vox
