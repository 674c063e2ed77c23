// Nearest neighbours in a tree of boxes, and the Hausdorff distance by branch and bound: what
// cannot be farther than the farthest so far is not looked at.

#include "libvox/inspect/nearest_active.h"

#include "libvox/core/parallel.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <limits>

namespace vox {
namespace {

using openvdb::Coord;
using openvdb::CoordBBox;

constexpr double kFar = std::numeric_limits<double>::infinity();
constexpr std::size_t kFanout = 4;

double squared(double x) {
  return x * x;
}

/// From a voxel to the nearest of a box.
double squaredDistance(const Coord& from, const CoordBBox& box) {
  double sum = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double below = static_cast<double>(box.min()[axis]) - from[axis];
    const double above = static_cast<double>(from[axis]) - box.max()[axis];
    sum += squared(std::max({0.0, below, above}));
  }
  return sum;
}

/// Order along a Morton curve: by the axis whose coordinates differ in the highest bit.
bool lessMorton(const Coord& a, const Coord& b) {
  std::uint32_t highest = 0;
  int axis = 0;
  for (int i = 0; i < 3; ++i) {
    const auto difference = static_cast<std::uint32_t>(a[i] ^ b[i]);
    if (std::bit_width(difference) <= std::bit_width(highest)) continue;
    highest = difference;
    axis = i;
  }
  return a[axis] < b[axis];
}

/// All boxes of one level, by fours.
template <class Boxes, class BoxOf>
std::vector<CoordBBox> byFours(const Boxes& below, BoxOf boxOf) {
  std::vector<CoordBBox> boxes((below.size() + kFanout - 1) / kFanout);
  for (std::size_t i = 0; i < below.size(); ++i) boxes[i / kFanout].expand(boxOf(below[i]));
  return boxes;
}

template <class Visit>
void forEachOn(const openvdb::util::NodeMask<3>& voxels, Visit&& visit) {
  for (auto voxel = voxels.beginOn(); voxel; ++voxel) visit(voxel.pos());
}

Coord inLeaf(const Coord& origin, openvdb::Index offset) {
  return origin.offsetBy(static_cast<int>(offset >> 6), static_cast<int>(offset >> 3 & 7),
                         static_cast<int>(offset & 7));
}

void raise(std::atomic<double>& most, double value) {
  double before = most.load(std::memory_order_relaxed);
  while (before < value && !most.compare_exchange_weak(before, value, std::memory_order_relaxed)) {
  }
}

void raiseBy(const LeafSurplus& leaf, const NearestActive& others, std::atomic<double>& most) {
  // Distance changes by at most one per voxel: no voxel is farther than the middle and this.
  constexpr double kReach = 6.93;  // 4 sqrt(3)
  const double before = std::sqrt(most.load(std::memory_order_relaxed));
  if (before > kReach) {
    const double enough = squared(before - kReach);
    if (others.squaredDistance(leaf.origin.offsetBy(4), enough) <= enough) return;
  }
  forEachOn(leaf.voxels, [&](openvdb::Index offset) {
    const double enough = most.load(std::memory_order_relaxed);
    raise(most, others.squaredDistance(inLeaf(leaf.origin, offset), enough));
  });
}

/// Rounded down, so that the highest corner is the farthest from it.
Coord middleOf(const CoordBBox& box) {
  Coord middle;
  for (int axis = 0; axis < 3; ++axis)
    middle[axis] =
        static_cast<openvdb::Int32>((std::int64_t{box.min()[axis]} + box.max()[axis]) >> 1);
  return middle;
}

void raiseBy(const CoordBBox& whole, const NearestActive& others, std::atomic<double>& most) {
  std::vector<CoordBBox> left = {whole};
  while (!left.empty()) {
    const CoordBBox box = left.back();
    left.pop_back();
    const Coord middle = middleOf(box);
    const double distance = others.squaredDistance(middle);
    raise(most, distance);
    const double reach = std::sqrt((box.max() - middle).asVec3d().lengthSqr());
    constexpr double kPrecision = 1.01;
    const double bound = kPrecision * std::sqrt(most.load(std::memory_order_relaxed));
    if (reach == 0 || std::sqrt(distance) + reach <= bound) continue;
    const auto axis = static_cast<int>(box.maxExtent());
    CoordBBox lower = box;
    CoordBBox upper = box;
    lower.max()[axis] = middle[axis];
    upper.min()[axis] = middle[axis] + 1;
    left.push_back(lower);
    left.push_back(upper);
  }
}

}  // namespace

struct NearestActive::Search {
  Coord from;
  double enough;
  double best = kFar;

  bool over() const { return best <= enough; }

  void look(const ActiveBlock& block) {
    if (block.leafVoxels == nullptr) {
      best = std::min(best, vox::squaredDistance(from, block.box));
      return;
    }
    forEachOn(*block.leafVoxels, [&](openvdb::Index offset) {
      const Coord at = inLeaf(block.box.min(), offset);
      best = std::min(best, vox::squaredDistance(from, CoordBBox(at, at)));
    });
  }
};

NearestActive::NearestActive(std::vector<ActiveBlock> blocks) : blocks_(std::move(blocks)) {
  sortInParallel(blocks_, [](const ActiveBlock& a, const ActiveBlock& b) {
    return lessMorton(a.box.min(), b.box.min());
  });
  if (blocks_.empty()) return;
  levels_.push_back(byFours(blocks_, [](const ActiveBlock& block) { return block.box; }));
  while (levels_.back().size() > 1)
    levels_.push_back(byFours(levels_.back(), [](const CoordBBox& box) { return box; }));
}

/// Looks into a box of a level, the nearest of what is in it first.
void NearestActive::look(Search& search, std::size_t level, std::size_t node) const {
  const std::size_t below = level == 0 ? blocks_.size() : levels_[level - 1].size();
  const std::size_t begin = node * kFanout;
  const std::size_t end = std::min(begin + kFanout, below);
  std::array<std::pair<double, std::size_t>, kFanout> order;
  for (std::size_t i = begin; i < end; ++i) {
    const CoordBBox& box = level == 0 ? blocks_[i].box : levels_[level - 1][i];
    order[i - begin] = {vox::squaredDistance(search.from, box), i};
  }
  std::sort(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(end - begin));
  for (std::size_t i = 0; i < end - begin; ++i) {
    const auto& [distance, child] = order[i];
    if (distance >= search.best || search.over()) return;
    if (level == 0)
      search.look(blocks_[child]);
    else
      look(search, level - 1, child);
  }
}

double NearestActive::squaredDistance(const Coord& from, double enoughSquared) const {
  Search search{from, enoughSquared};
  if (!empty()) look(search, levels_.size() - 1, 0);
  return search.best;
}

double largestDistance(std::span<const LeafSurplus> leaves, std::span<const CoordBBox> boxes,
                       const NearestActive& others) {
  if (leaves.empty() && boxes.empty()) return 0;
  if (others.empty()) return kFar;
  std::atomic<double> mostSquared{0};
  constexpr std::size_t kGrain = 16;
  forEach(leaves.size(), kGrain, [&](std::size_t i) { raiseBy(leaves[i], others, mostSquared); });
  // One after the other: where the search stops depends on what was found before.
  for (const CoordBBox& box : boxes) raiseBy(box, others, mostSquared);
  return std::sqrt(mostSquared.load());
}

}  // namespace vox
