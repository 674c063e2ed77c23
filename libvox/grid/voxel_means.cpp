// Sums of vectors, a slot for each black voxel.

#include "libvox/grid/voxel_means.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <utility>

namespace vox {
namespace {

constexpr double kOne = 1 << 30;

void addTo(std::int64_t& sum, std::int64_t value) {
  std::atomic_ref(sum).fetch_add(value, std::memory_order_relaxed);
}

std::int64_t fixedPoint(double value) {
  return std::llround(std::clamp(value, -1.0, 1.0) * kOne);
}

/// How many voxels of a leaf come before one of them.
std::size_t rankIn(const openvdb::MaskTree::LeafNodeType& leaf, openvdb::Index offset) {
  constexpr openvdb::Index kBits = 64;
  const auto& mask = leaf.getValueMask();
  const openvdb::Index last = offset / kBits;
  int rank = 0;
  for (openvdb::Index word = 0; word < last; ++word)
    rank += std::popcount(mask.getWord<std::uint64_t>(word));
  const std::uint64_t before = (std::uint64_t{1} << (offset % kBits)) - 1;
  rank += std::popcount(mask.getWord<std::uint64_t>(last) & before);
  return static_cast<std::size_t>(rank);
}

}  // namespace

VoxelMeans::VoxelMeans(const openvdb::MaskTree& voxels) : voxels_(voxels) {
  std::size_t slots = 0;
  firstSlots_.reserve(voxels.leafCount());
  for (auto leaf = voxels.cbeginLeaf(); leaf; ++leaf) {
    firstSlots_.emplace(leaf.getLeaf(), slots);
    slots += leaf->onVoxelCount();
  }
  sums_.resize(slots);
}

std::uint64_t VoxelMeans::bytesFor(std::uint64_t voxels, std::uint64_t leaves) {
  constexpr std::uint64_t kPerLeaf = 48;  // of the table of first slots
  return voxels * sizeof(Sum) + leaves * kPerLeaf;
}

void VoxelMeans::Writer::add(const openvdb::Coord& voxel, const Vec3d& vector) {
  const openvdb::Coord origin = voxel & ~static_cast<openvdb::Int32>(Leaf::DIM - 1);
  if (leaf_ == nullptr || leaf_->origin() != origin) {
    leaf_ = leaves_.probeConstLeaf(voxel);
    if (leaf_ == nullptr) return;
    first_ = means_.firstSlots_.at(leaf_);
  }
  const openvdb::Index offset = Leaf::coordToOffset(voxel);
  if (!leaf_->isValueOn(offset)) return;
  Sum& sum = means_.sums_[first_ + rankIn(*leaf_, offset)];
  addTo(sum.x, fixedPoint(vector.x()));
  addTo(sum.y, fixedPoint(vector.y()));
  addTo(sum.z, fixedPoint(vector.z()));
  addTo(sum.count, 1);
}

const VoxelMeans::Sum* VoxelMeans::sumAt(const Leaf* leaf, const openvdb::Coord& voxel) const {
  if (leaf == nullptr || !leaf->isValueOn(voxel)) return nullptr;
  return &sums_[firstSlots_.at(leaf) + rankIn(*leaf, Leaf::coordToOffset(voxel))];
}

VoxelMeans::Sum VoxelMeans::meanOfNeighbours(const Accessor& leaves,
                                             const openvdb::Coord& voxel) const {
  Sum sum;
  for (int n = 0; n < 27; ++n) {
    const openvdb::Coord near = voxel.offsetBy(n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1);
    const Sum* const other = sumAt(leaves.probeConstLeaf(near), near);
    if (other == nullptr || other->count == 0) continue;
    sum.x += other->x / other->count;
    sum.y += other->y / other->count;
    sum.z += other->z / other->count;
    ++sum.count;
  }
  return sum;
}

std::vector<VoxelMeans::Gap> VoxelMeans::gaps() const {
  std::vector<Gap> gaps;
  std::size_t slot = 0;
  for (auto leaf = voxels_.cbeginLeaf(); leaf; ++leaf)
    for (auto voxel = leaf->cbeginValueOn(); voxel; ++voxel, ++slot)
      if (sums_[slot].count == 0) gaps.push_back({voxel.getCoord(), slot});
  return gaps;
}

void VoxelMeans::fillGaps() {
  const Accessor leaves(voxels_);
  std::vector<Gap> open = gaps();
  while (!open.empty()) {
    std::vector<Gap> stillOpen;
    std::vector<std::pair<std::size_t, Sum>> filled;  // not seen before all of this round are
    for (const Gap& gap : open) {
      const Sum mean = meanOfNeighbours(leaves, gap.voxel);
      if (mean.count > 0)
        filled.emplace_back(gap.slot, mean);
      else
        stillOpen.push_back(gap);
    }
    if (filled.empty()) return;
    for (const auto& [slot, mean] : filled) sums_[slot] = mean;
    open = std::move(stillOpen);
  }
}

std::optional<Vec3d> VoxelMeans::meanOf(const openvdb::Coord& voxel) const {
  const Sum* const sum = sumAt(voxels_.probeConstLeaf(voxel), voxel);
  if (sum == nullptr || sum->count == 0) return std::nullopt;
  const Vec3d total(static_cast<double>(sum->x), static_cast<double>(sum->y),
                    static_cast<double>(sum->z));
  return total / (kOne * static_cast<double>(sum->count));
}

}  // namespace vox
