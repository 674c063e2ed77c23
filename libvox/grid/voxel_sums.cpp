// One slot for each active voxel.

#include "libvox/grid/voxel_sums.h"

#include <atomic>
#include <bit>
#include <cmath>

namespace vox {

VoxelSums::VoxelSums(const openvdb::MaskTree& mask) {
  first_.reserve(mask.leafCount());
  std::size_t count = 0;
  for (auto leaf = mask.cbeginLeaf(); leaf; ++leaf) {
    first_.emplace(leaf->origin(), Place{&*leaf, count});
    count += leaf->onVoxelCount();
  }
  sums_.assign(count, Sum{});
}

std::size_t VoxelSums::slotOf(const Place& place, unsigned voxel) {
  const auto& mask = place.leaf->valueMask();
  const unsigned word = voxel / 64;
  std::size_t slot = place.first;
  for (unsigned w = 0; w < word; ++w)
    slot += static_cast<std::size_t>(std::popcount(mask.template getWord<std::uint64_t>(w)));
  const std::uint64_t below = (std::uint64_t{1} << (voxel % 64)) - 1;
  return slot + static_cast<std::size_t>(
                    std::popcount(mask.template getWord<std::uint64_t>(word) & below));
}

void VoxelSums::add(const Place& place, unsigned voxel, const Vec3d& vector) {
  Sum& sum = sums_[slotOf(place, voxel)];
  for (int axis = 0; axis < 3; ++axis) {
    const std::int64_t part = std::llrint(vector[axis] / kUnit);
    std::atomic_ref(sum[static_cast<std::size_t>(axis)]).fetch_add(part, std::memory_order_relaxed);
  }
}

Vec3d VoxelSums::sum(const Place& place, unsigned voxel) const {
  const Sum& sum = sums_[slotOf(place, voxel)];
  return {static_cast<double>(sum[0]), static_cast<double>(sum[1]), static_cast<double>(sum[2])};
}

}  // namespace vox
