// Sums of vectors: one slot for each active voxel, leaf after leaf.

#include "libvox/grid/voxel_means.h"

#include "libvox/core/parallel.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdlib>
#include <new>

namespace vox {
namespace {

using Leaf = openvdb::MaskTree::LeafNodeType;

constexpr double kOne = std::int64_t{1} << VoxelMeans::kFractionBits;

std::int64_t fixedPoint(double value) {
  return std::llround(std::clamp(value, -1.0, 1.0) * kOne);
}

std::uint64_t wordOf(const Leaf& leaf, std::size_t word) {
  return leaf.getValueMask().getWord<std::uint64_t>(static_cast<openvdb::Index>(word));
}

std::size_t onesBelow(std::uint64_t word, unsigned bit) {
  return static_cast<std::size_t>(std::popcount(word & ((std::uint64_t{1} << bit) - 1)));
}

/// Number of active voxels of a leaf before the one at `offset`.
std::size_t rankIn(const Leaf& leaf, openvdb::Index offset) {
  constexpr openvdb::Index kBits = 64;
  std::size_t rank = 0;
  for (std::size_t word = 0; word < offset / kBits; ++word)
    rank += static_cast<std::size_t>(std::popcount(wordOf(leaf, word)));
  return rank + onesBelow(wordOf(leaf, offset / kBits), offset % kBits);
}

}  // namespace

void VoxelMeans::FreeSums::operator()(Sum* sums) const {
  std::free(sums);
}

VoxelMeans::VoxelMeans(const openvdb::MaskTree& voxels) {
  voxels.getNodes(leaves_);
  firstSlots_.reserve(leaves_.size());
  std::size_t slots = 0;
  Page* page = nullptr;
  openvdb::Coord pageOrigin;
  for (std::size_t i = 0; i < leaves_.size(); ++i) {
    const openvdb::Coord origin = leaves_[i]->origin();
    if (page == nullptr || pageOriginOf(origin) != pageOrigin) {
      pageOrigin = pageOriginOf(origin);
      auto& place = pages_[pageOrigin];
      if (place == nullptr) {
        place = std::make_unique<Page>();
        place->fill(kNoLeaf);
      }
      page = place.get();
    }
    (*page)[placeInPage(origin)] = static_cast<std::uint32_t>(i);
    firstSlots_.push_back(slots);
    slots += leaves_[i]->onVoxelCount();
  }
  locks_ = std::make_unique<tbb::spin_mutex[]>(leaves_.size());
  // calloc: the system zeroes each page of memory when a thread first uses it.
  sums_.reset(static_cast<Sum*>(std::calloc(std::max<std::size_t>(slots, 1), sizeof(Sum))));
  if (sums_ == nullptr) throw std::bad_alloc();
}

std::uint64_t VoxelMeans::bytesFor(std::uint64_t voxels, std::uint64_t leaves) {
  constexpr std::uint64_t kPerLeaf = 256;  // bytes of the tables, if a page has 64 leaves
  return voxels * sizeof(Sum) + leaves * kPerLeaf;
}

std::size_t VoxelMeans::placeInPage(const openvdb::Coord& leafOrigin) {
  constexpr int kLeafLog2 = 3;
  constexpr int kSideLog2 = kPageLog2 - kLeafLog2;
  const auto in = [](std::int32_t v) {
    return static_cast<std::size_t>(v >> kLeafLog2 & ((1 << kSideLog2) - 1));
  };
  return in(leafOrigin.x()) << (2 * kSideLog2) | in(leafOrigin.y()) << kSideLog2 |
         in(leafOrigin.z());
}

const std::uint32_t* VoxelMeans::pageAt(const openvdb::Coord& pageOrigin) const {
  const auto found = pages_.find(pageOrigin);
  return found == pages_.end() ? nullptr : found->second->data();
}

std::uint32_t VoxelMeans::leafAt(const openvdb::Coord& leafOrigin) const {
  const std::uint32_t* const page = pageAt(pageOriginOf(leafOrigin));
  return page == nullptr ? kNoLeaf : page[placeInPage(leafOrigin)];
}

bool VoxelMeans::Writer::find(const openvdb::Coord& leafOrigin) {
  if (leaf_ != kNoLeaf && leafOrigin == leafOrigin_) return true;
  const openvdb::Coord pageOrigin = pageOriginOf(leafOrigin);
  if (page_ == nullptr || pageOrigin != pageOrigin_) {
    page_ = means_.pageAt(pageOrigin);
    pageOrigin_ = pageOrigin;
  }
  leafOrigin_ = leafOrigin;
  leaf_ = page_ == nullptr ? kNoLeaf : page_[placeInPage(leafOrigin)];
  return leaf_ != kNoLeaf;
}

void VoxelMeans::Writer::add(const openvdb::Coord& voxel, const Vec3d& vector) {
  if (!find(voxel & ~static_cast<openvdb::Int32>(Leaf::DIM - 1))) return;
  const Leaf& leaf = *means_.leaves_[leaf_];
  const openvdb::Index offset = Leaf::coordToOffset(voxel);
  if (!leaf.isValueOn(offset)) return;
  const Sum sample = {fixedPoint(vector.x()), fixedPoint(vector.y()), fixedPoint(vector.z()), 1};
  Sum& sum = means_.sums_[means_.firstSlots_[leaf_] + rankIn(leaf, offset)];
  const tbb::spin_mutex::scoped_lock lock(means_.locks_[leaf_]);
  sum.add(sample, 1);
}

void VoxelMeans::Writer::take(const openvdb::Coord& leafOrigin, const LeafWords& touched,
                              BrickSum* sums) {
  constexpr std::int64_t kUnit = std::int64_t{1} << (kFractionBits - kBrickFractionBits);
  const bool exists = find(leafOrigin);
  tbb::spin_mutex::scoped_lock lock;
  Sum* slot = nullptr;
  if (exists) {
    lock.acquire(means_.locks_[leaf_]);
    slot = &means_.sums_[means_.firstSlots_[leaf_]];
  }
  for (std::size_t word = 0; word < touched.size(); ++word) {
    BrickSum* const ofWord = sums + 64 * word;
    for (std::uint64_t active = exists ? wordOf(*means_.leaves_[leaf_], word) : 0; active != 0;
         active &= active - 1, ++slot) {
      const int bit = std::countr_zero(active);
      if ((touched[word] >> bit & 1U) != 0) slot->add(ofWord[bit], kUnit);
    }
    for (std::uint64_t left = touched[word]; left != 0; left &= left - 1)
      ofWord[std::countr_zero(left)] = {};
  }
}

const VoxelMeans::Sum* VoxelMeans::sumAt(const openvdb::Coord& voxel) const {
  const std::uint32_t i = leafAt(voxel & ~static_cast<openvdb::Int32>(Leaf::DIM - 1));
  if (i == kNoLeaf || !leaves_[i]->isValueOn(voxel)) return nullptr;
  return &sums_[firstSlots_[i] + rankIn(*leaves_[i], Leaf::coordToOffset(voxel))];
}

VoxelMeans::Sum VoxelMeans::meanOfNeighbours(const openvdb::Coord& voxel) const {
  Sum sum;
  for (int n = 0; n < 27; ++n) {
    const Sum* const other = sumAt(voxel.offsetBy(n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1));
    if (other == nullptr || other->count == 0) continue;
    sum.x += other->x / other->count;
    sum.y += other->y / other->count;
    sum.z += other->z / other->count;
    ++sum.count;
  }
  return sum;
}

std::vector<VoxelMeans::Gap> VoxelMeans::gaps() const {
  constexpr std::size_t kLeavesPerPart = 256;
  std::vector<std::vector<Gap>> parts((leaves_.size() + kLeavesPerPart - 1) / kLeavesPerPart);
  parallelForEach(parts.size(), 1, [&](std::size_t part) {
    const std::size_t end = std::min(leaves_.size(), (part + 1) * kLeavesPerPart);
    for (std::size_t i = part * kLeavesPerPart; i < end; ++i) {
      std::size_t slot = firstSlots_[i];
      for (auto voxel = leaves_[i]->cbeginValueOn(); voxel; ++voxel, ++slot)
        if (sums_[slot].count == 0) parts[part].push_back({voxel.getCoord(), slot});
    }
  });
  std::vector<Gap> all;
  for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

void VoxelMeans::fillGaps() {
  std::vector<Gap> open = gaps();
  while (!open.empty()) {
    std::vector<Sum> means(open.size());  // stored after the round, so that order does not matter
    constexpr std::size_t kGapsPerTask = 256;
    parallelForEach(open.size(), kGapsPerTask,
                    [&](std::size_t i) { means[i] = meanOfNeighbours(open[i].voxel); });
    std::vector<Gap> stillOpen;
    for (std::size_t i = 0; i < open.size(); ++i) {
      if (means[i].count > 0)
        sums_[open[i].slot] = means[i];
      else
        stillOpen.push_back(open[i]);
    }
    if (stillOpen.size() == open.size()) return;
    open = std::move(stillOpen);
  }
}

std::optional<Vec3d> VoxelMeans::meanOf(const openvdb::Coord& voxel) const {
  const Sum* const sum = sumAt(voxel);
  if (sum == nullptr || sum->count == 0) return std::nullopt;
  const Vec3d total(static_cast<double>(sum->x), static_cast<double>(sum->y),
                    static_cast<double>(sum->z));
  return total / (kOne * static_cast<double>(sum->count));
}

const VoxelMeans::Sum* VoxelMeans::sumsOf(const openvdb::Coord& leafOrigin) const {
  const std::uint32_t i = leafAt(leafOrigin);
  return i == kNoLeaf ? nullptr : &sums_[firstSlots_[i]];
}

}  // namespace vox
