// Nearest neighbours in a tree of boxes, and the Hausdorff distance by branch and bound: voxels
// that cannot be farther than the farthest one so far are skipped.

#include "libvox/inspect/nearest_active.h"

#include "libvox/core/parallel.h"
#include "libvox/grid/openvdb.h"

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <limits>
#include <utility>

namespace vox {
namespace {

using openvdb::Coord;
using openvdb::CoordBBox;

constexpr double kFar = std::numeric_limits<double>::infinity();
constexpr std::size_t kFanout = 4;

constexpr double squared(double x) {
  return x * x;
}

/// From a voxel to the nearest voxel of a box.
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

/// Joins the boxes of a level in groups of four.
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

Coord voxelInLeaf(const Coord& origin, openvdb::Index offset) {
  return origin.offsetBy(static_cast<int>(offset >> 6), static_cast<int>(offset >> 3 & 7),
                         static_cast<int>(offset & 7));
}

void raise(std::atomic<double>& most, double value) {
  double before = most.load(std::memory_order_relaxed);
  while (before < value && !most.compare_exchange_weak(before, value, std::memory_order_relaxed)) {
  }
}

/// The voxels of a leaf and of the 26 around it, as rows of bits along z.
class Surroundings {
 public:
  Surroundings(const Coord& origin, const NearestActive& others) {
    for (int leaf = 0; leaf < 27; ++leaf) {
      const Coord at(leaf / 9, leaf / 3 % 3, leaf % 3);
      const auto* const voxels = others.leafAt(origin + ((at - Coord(1)) << 3));
      if (voxels == nullptr) continue;
      for (std::size_t row = 0; row < 64; ++row)
        rows_[rowAt(at.x(), row >> 3U)][rowAt(at.y(), row & 7U)] |=
            (voxels->getWord<openvdb::Index64>(static_cast<openvdb::Index>(row >> 3U)) >>
                 (8 * (row & 7U)) &
             0xFFU)
            << (8 * at.z());
    }
  }

  /// Removes the voxels of the middle leaf that have one of these voxels within a distance of at
  /// most kMostReach.
  void takeNear(double squaredReach, openvdb::util::NodeMask<3>& voxels) const {
    const int reach = static_cast<int>(std::sqrt(squaredReach));
    std::vector<Rows> wide = {rows_};  // [n]: with their neighbours up to n along z
    for (int n = 1; n <= reach; ++n) {
      wide.push_back(wide.back());
      for (auto& slab : wide.back())
        for (std::uint64_t& row : slab) row |= row << 1U | row >> 1U;
    }
    for (int dx = -reach; dx <= reach; ++dx)
      for (int dy = -reach; dy <= reach; ++dy) {
        const double left = squaredReach - dx * dx - dy * dy;
        if (left < 0) continue;
        const Rows& rows = wide[static_cast<std::size_t>(std::sqrt(left))];
        for (int x = 0; x < kLeaf; ++x) {
          const auto& slab = rows[static_cast<std::size_t>(kLeaf + x + dx)];
          auto& word = voxels.getWord<openvdb::Index64>(static_cast<openvdb::Index>(x));
          for (int y = 0; y < kLeaf; ++y)
            word &= ~((slab[static_cast<std::size_t>(kLeaf + y + dy)] >> 8U & 0xFFU) << (8 * y));
        }
      }
  }

  static constexpr double kMostReach = 8;

 private:
  static constexpr std::size_t kSide = 24;
  static std::size_t rowAt(int leaf, std::size_t row) {
    return 8 * static_cast<std::size_t>(leaf) + row;
  }

  static constexpr int kLeaf = 8;
  using Rows = std::array<std::array<std::uint64_t, kSide>, kSide>;
  Rows rows_{};
};

/// Removes voxels that are not as far as the farthest one so far: cheaply, a leaf at a time.
LeafSurplus withoutNear(LeafSurplus leaf, const NearestActive& others, double mostSquared) {
  constexpr double kMost = squared(Surroundings::kMostReach);
  if (mostSquared >= 1)
    Surroundings(leaf.origin, others).takeNear(std::min(mostSquared, kMost), leaf.voxels);
  return leaf;
}

void raiseBy(const LeafSurplus& whole, const NearestActive& others, std::atomic<double>& most) {
  // Distance changes by at most one per voxel: no voxel is farther than the middle and this.
  constexpr double kReach = 6.93;  // 4 sqrt(3)
  const double beforeSquared = most.load(std::memory_order_relaxed);
  const double before = std::sqrt(beforeSquared);
  const LeafSurplus leaf = withoutNear(whole, others, beforeSquared);
  if (leaf.voxels.isOff()) return;
  if (before > kReach) {
    const double enough = squared(before - kReach);
    if (others.squaredDistance(leaf.origin.offsetBy(4), enough) <= enough) return;
  }
  forEachOn(leaf.voxels, [&](openvdb::Index offset) {
    const double enough = most.load(std::memory_order_relaxed);
    raise(most, others.squaredDistance(voxelInLeaf(leaf.origin, offset), enough));
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
      const Coord at = voxelInLeaf(block.box.min(), offset);
      best = std::min(best, vox::squaredDistance(from, CoordBBox(at, at)));
    });
  }
};

NearestActive::NearestActive(std::vector<ActiveBlock> blocks) : blocks_(std::move(blocks)) {
  parallelSort(blocks_, [](const ActiveBlock& a, const ActiveBlock& b) {
    return lessMorton(a.box.min(), b.box.min());
  });
  if (blocks_.empty()) return;
  levels_.push_back(byFours(blocks_, [](const ActiveBlock& block) { return block.box; }));
  while (levels_.back().size() > 1)
    levels_.push_back(byFours(levels_.back(), [](const CoordBBox& box) { return box; }));
}

const openvdb::util::NodeMask<3>* NearestActive::leafAt(const Coord& origin) const {
  const auto found = std::lower_bound(
      blocks_.begin(), blocks_.end(), origin,
      [](const ActiveBlock& block, const Coord& at) { return lessMorton(block.box.min(), at); });
  return found != blocks_.end() && found->box.min() == origin ? found->leafVoxels : nullptr;
}

/// Searches a box of a level, the nearest box in it first.
void NearestActive::look(Search& search, std::size_t level, std::size_t node) const {
  const std::size_t below = level == 0 ? blocks_.size() : levels_[level - 1].size();
  const std::size_t begin = node * kFanout;
  const std::size_t end = std::min(begin + kFanout, below);
  std::array<std::pair<double, std::size_t>, kFanout> order;
  order.fill({std::numeric_limits<double>::infinity(), below});
  for (std::size_t i = begin; i < end; ++i) {
    const CoordBBox& box = level == 0 ? blocks_[i].box : levels_[level - 1][i];
    order[i - begin] = {vox::squaredDistance(search.from, box), i};
  }
  std::sort(order.begin(), order.end());
  for (const auto& [distance, child] : order) {
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
  parallelForEach(leaves.size(), kGrain,
                  [&](std::size_t i) { raiseBy(leaves[i], others, mostSquared); });
  // One after the other: each search stops at the largest distance that the earlier ones found.
  for (const CoordBBox& box : boxes) raiseBy(box, others, mostSquared);
  return std::sqrt(mostSquared.load());
}

}  // namespace vox
