// Distances to the outside. Around a voxel outside, a ball with the radius of its distance is
// empty. So the distance of a voxel inside is at most that to the nearest ball, and no less than
// this by more than the balls leave between them. A foot that is nearer is hidden.

#include "libvox/foot/exposed_band.h"

#include "libvox/core/parallel.h"
#include "libvox/core/progress.h"
#include "libvox/foot/scan_bin.h"
#include "libvox/grid/leaf_words.h"
#include "libvox/grid/openvdb.h"

#include <openvdb/tools/SignedFloodFill.h>
#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>
#include <vector>

namespace vox {
namespace {

using openvdb::Coord;
using Leaf = openvdb::FloatTree::LeafNodeType;
using MaskLeaf = openvdb::MaskTree::LeafNodeType;

/// Balls may leave this much uncovered: a foot is exposed if it is this near to a ball.
constexpr float kUncovered = 0.06F;  // voxels
/// Balls must overlap this much to show that there is no surface between their centres.
constexpr float kLeastOverlap = 0.02F;
constexpr float kLeastOverlapInside = 0.1F;  // where the foot says inside

/// Voxels on the inner side of their foot may be outside if the surface is inside out there; but if
/// it does not cross them, the solid voxels tell.
constexpr float kMostCrossed = 1;  // voxels

constexpr float kLargestBall = 3;      // voxels
constexpr float kLeastChange = 0.25F;  // voxels, where the hidden surface goes on

float distanceBetween(const Coord& a, const Coord& b) {
  const Coord d = a - b;
  return std::sqrt(static_cast<float>(d.x() * d.x() + d.y() * d.y() + d.z() * d.z()));
}

bool isSolid(const openvdb::MaskTree& solid, const MaskLeaf* leaf, const Coord& origin,
             openvdb::Index voxel) {
  return leaf != nullptr ? leaf->isValueOn(voxel) : solid.isValueOn(origin);
}

LeafWords solidWords(const openvdb::MaskTree& solid, const Coord& leafOrigin) {
  if (const MaskLeaf* leaf = solid.probeConstLeaf(leafOrigin)) return activeWords(*leaf);
  LeafWords words;
  words.fill(solid.isValueOn(leafOrigin) ? ~std::uint64_t{0} : 0);
  return words;
}

/// Whether one of the 26 neighbours of a voxel is not solid.
bool isNearOutside(const openvdb::MaskTree& solid, const Coord& voxel) {
  for (int i = 0; i < 27; ++i)
    if (!solid.isValueOn(voxel.offsetBy(i / 9 - 1, i / 3 % 3 - 1, i % 3 - 1))) return true;
  return false;
}

/// Hidden voxels of a leaf, and others whose sign may not be that of the foot: on the outer side of
/// an exposed part, a neighbour is outside.
openvdb::CoordBBox doubtfulBox(const Leaf& leaf, const openvdb::MaskTree& solid, float hidden) {
  const LeafWords inSolid = solidWords(solid, leaf.origin());
  const LeafWords nearOutside = allNeighboursOf(complementOf(inSolid));
  openvdb::CoordBBox box;
  const float* values = leaf.buffer().data();
  for (openvdb::Index x = 0; x < 8; ++x) {
    const auto active = leaf.getValueMask().getWord<openvdb::Index64>(x);
    std::uint64_t far = 0, minus = 0;
    for (unsigned bit = 0; bit < 64; ++bit) {
      far |= std::uint64_t{values[x << 6 | bit] > hidden} << bit;
      minus |= std::uint64_t{values[x << 6 | bit] < 0} << bit;
    }
    const auto voxel = [&](std::uint64_t bits) {
      return leaf.offsetToGlobalCoord(x << 6 | static_cast<unsigned>(std::countr_zero(bits)));
    };
    for (std::uint64_t left = active & ((far & inSolid[x]) | (minus & ~inSolid[x])); left != 0;
         left &= left - 1)
      box.expand(voxel(left));
    for (std::uint64_t left = active & inSolid[x] & ~minus & ~far & ~nearOutside[x]; left != 0;
         left &= left - 1)
      if (!isNearOutside(solid, voxel(left))) box.expand(voxel(left));
  }
  return box;
}

/// The balls around the voxels outside, near a leaf.
class Balls {
 public:
  /// @param reach  voxels: balls that are farther from a voxel are of no interest
  explicit Balls(double reach)
      : around_(static_cast<int>(std::ceil(reach + kLargestBall))), side_(8 + 2 * around_) {
    const auto voxels = static_cast<std::size_t>(side_) * static_cast<std::size_t>(side_) *
                        static_cast<std::size_t>(side_);
    radii_.resize(voxels);
  }

  void set(const openvdb::FloatTree& band, const openvdb::MaskTree& solid, const Coord& leafOrigin,
           float voxelSize) {
    origin_ = leafOrigin.offsetBy(-around_);
    std::fill(radii_.begin(), radii_.end(), 0.0F);
    balls_.clear();
    groups_.clear();
    const Coord last = origin_.offsetBy(side_ - 1);
    for (auto at = openvdb::CoordBBox(origin_ >> 3, last >> 3).begin(); at; ++at)
      if (const Leaf* leaf = band.probeConstLeaf(*at << 3)) addLeaf(*leaf, solid, voxelSize);
    lastBall_ = lastStep_ = Coord::max();
  }

  /// Whether a ball at the place of the last nearest one is at most this far from a voxel.
  bool hasNear(const Coord& voxel, float distance) {
    if (lastBall_ == Coord::max()) return false;
    if (isWithin(voxel, lastBall_, distance)) return true;
    if (!isWithin(voxel, voxel + lastStep_, distance)) return false;
    lastBall_ = voxel + lastStep_;
    return true;
  }

  /// Whether a ball around one of the 26 neighbours is at most this far from a voxel.
  bool neighboursHave(const Coord& voxel, float distance) const {
    for (int i = 0; i < 27; ++i)
      if (isWithin(voxel, voxel.offsetBy(i / 9 - 1, i / 3 % 3 - 1, i % 3 - 1), distance))
        return true;
    return false;
  }

  /// Distance from a voxel to the nearest ball; or `most`, if none is nearer.
  float nearest(const Coord& voxel, float most) {
    const Coord at = voxel - origin_;
    const auto vx = static_cast<float>(at.x()), vy = static_cast<float>(at.y()),
               vz = static_cast<float>(at.z());
    float least = most;
    std::size_t found = balls_.size();
    for (const Group& group : groups_) {
      const float outermost = least + kLargestBall;
      if (squareDistance(group.box, voxel) > outermost * outermost) continue;
      for (std::size_t i = group.begin; i < group.end; ++i) {
        const Ball& ball = balls_[i];
        const float dx = ball.x - vx, dy = ball.y - vy, dz = ball.z - vz;
        const float square = dx * dx + dy * dy + dz * dz;
        const float reach = least + ball.radius;
        if (reach <= 0 || square >= reach * reach) continue;
        least = std::sqrt(square) - ball.radius;
        found = i;
      }
    }
    if (found < balls_.size()) {
      const Ball& ball = balls_[found];
      lastBall_ = origin_ + Coord(static_cast<int>(ball.x), static_cast<int>(ball.y),
                                  static_cast<int>(ball.z));
      lastStep_ = lastBall_ - voxel;
    }
    return least;
  }

 private:
  struct Ball {
    float x, y, z, radius;
  };
  /// The balls of a leaf.
  struct Group {
    openvdb::CoordBBox box;
    std::size_t begin, end;
  };

  static float squareDistance(const openvdb::CoordBBox& box, const Coord& voxel) {
    float square = 0;
    for (int axis = 0; axis < 3; ++axis) {
      const int beyond =
          std::max({0, box.min()[axis] - voxel[axis], voxel[axis] - box.max()[axis]});
      square += static_cast<float>(beyond * beyond);
    }
    return square;
  }

  void addLeaf(const Leaf& leaf, const openvdb::MaskTree& solid, float voxelSize) {
    const MaskLeaf* const solidLeaf = solid.probeConstLeaf(leaf.origin());
    if (solidLeaf == nullptr && solid.isValueOn(leaf.origin())) return;
    const openvdb::CoordBBox cube(origin_, origin_.offsetBy(side_ - 1));
    Group group{{}, balls_.size(), 0};
    for (openvdb::Index x = 0; x < 8; ++x) {
      auto outside = leaf.getValueMask().getWord<openvdb::Index64>(x);
      if (solidLeaf != nullptr) outside &= ~solidLeaf->getValueMask().getWord<openvdb::Index64>(x);
      for (; outside != 0; outside &= outside - 1) {
        const auto voxel = x << 6 | static_cast<openvdb::Index>(std::countr_zero(outside));
        const float radius = std::abs(leaf.getValue(voxel)) / voxelSize;
        const Coord at = leaf.offsetToGlobalCoord(voxel);
        if (radius > kLargestBall || !cube.isInside(at)) continue;
        group.box.expand(at);
        const Coord local = at - origin_;
        radii_[indexOf(local)] = radius;
        balls_.push_back({static_cast<float>(local.x()), static_cast<float>(local.y()),
                          static_cast<float>(local.z()), radius});
      }
    }
    group.end = balls_.size();
    if (group.end > group.begin) groups_.push_back(group);
  }

  bool isWithin(const Coord& voxel, const Coord& ball, float distance) const {
    const Coord at = ball - origin_;
    for (int axis = 0; axis < 3; ++axis)
      if (at[axis] < 0 || at[axis] >= side_) return false;
    const float radius = radii_[indexOf(at)];
    return radius > 0 && distanceBetween(ball, voxel) - radius <= distance;
  }

  std::size_t indexOf(const Coord& at) const {
    return static_cast<std::size_t>((at.x() * side_ + at.y()) * side_ + at.z());
  }

  int around_, side_;  // voxels around the leaf, and of the cube
  Coord origin_;
  std::vector<float> radii_;  // of all voxels; 0: not surely outside
  std::vector<Ball> balls_;
  std::vector<Group> groups_;
  Coord lastBall_, lastStep_;
};

/// New values of a leaf.
struct NewLeaf {
  Leaf* leaf;
  std::array<float, FootBrick::kVoxels> values;
  openvdb::util::NodeMask<Leaf::LOG2DIM> mask;
};

/// A voxel inside whose nearest foot is hidden.
struct HiddenFoot {
  std::size_t leaf;  // of the bin
  openvdb::Index voxel;
  float most;  // its distance is at most this, voxels
};

class Exposure {
 public:
  Exposure(const Band& band, const FootBins& bins, openvdb::MaskTree& solid, double hidden,
           const BandOptions& options, const Progress& progress)
      : band_(*band.tree),
        jumps_(band.jumps),
        bins_(bins),
        solid_(solid),
        options_(options),
        progress_(progress),
        hidden_(static_cast<float>(hidden * options.voxelSize)),
        voxelSize_(static_cast<float>(options.voxelSize)) {}

  /// A leaf next to voxels that have changed is looked at, too, until no more change.
  void run() {
    for (std::size_t bin = 0; bin < bins_.count(); ++bin)
      binAt_.emplace_back(bins_.originOf(bin), bin);
    std::sort(binAt_.begin(), binAt_.end());
    std::vector<openvdb::CoordBBox> changes = doubtfulBoxes();
    while (true) {
      const std::vector<Leaf*> leaves = leavesAround(changes);
      if (leaves.empty()) break;
      freeOutside(leaves);
      changes = correct(leaves);
    }
    if (!known_.empty())
      openvdb::tools::signedFloodFillWithValues(
          band_, backgroundOf(options_.out, options_.voxelSize),
          -backgroundOf(options_.in, options_.voxelSize), true, 1, 1);
  }

 private:
  /// Of one thread.
  struct Work {
    explicit Work(double reach) : balls(reach) {}
    Balls balls;
    WantedFeet wanted;
    std::vector<HiddenFoot> hidden;
    Feet feet;
    FootBrick brick;
  };

  /// Boxes around voxels of leaves that a hidden surface may be near.
  std::vector<openvdb::CoordBBox> doubtfulBoxes() const {
    std::vector<const Leaf*> leaves;
    band_.getNodes(leaves);
    std::vector<openvdb::CoordBBox> boxes(leaves.size());
    constexpr std::size_t kLeavesPerTask = 64;
    parallelForEach(leaves.size(), kLeavesPerTask,
                    [&](std::size_t l) { boxes[l] = doubtfulBox(*leaves[l], solid_, hidden_); });
    for (const Coord& leaf : jumps_) boxes.push_back(openvdb::CoordBBox::createCube(leaf, 8));
    return boxes;
  }

  /// The leaves next to some voxels, as far as they are not known yet; by bins.
  std::vector<Leaf*> leavesAround(std::span<const openvdb::CoordBBox> boxes) {
    std::vector<Leaf*> leaves;
    for (openvdb::CoordBBox box : boxes) {
      if (box.empty()) continue;
      box.expand(1);
      for (auto at = openvdb::CoordBBox(box.min() >> 3, box.max() >> 3).begin(); at; ++at) {
        const Coord origin = *at << 3;
        if (known_.probeConstLeaf(origin) != nullptr) continue;
        Leaf* leaf = band_.probeLeaf(origin);
        if (leaf == nullptr) continue;
        known_.touchLeaf(origin);
        leaves.push_back(leaf);
      }
    }
    const auto orderOf = [](const Leaf* leaf) {
      return std::make_pair(leaf->origin() & ~(kBinSide - 1), leaf->origin());
    };
    std::sort(leaves.begin(), leaves.end(),
              [&](const Leaf* a, const Leaf* b) { return orderOf(a) < orderOf(b); });
    return leaves;
  }

  /// Corrects the values of some leaves. Returns boxes around those that have changed.
  std::vector<openvdb::CoordBBox> correct(const std::vector<Leaf*>& leaves) {
    std::vector<std::pair<std::size_t, std::vector<NewLeaf>>> bins;
    for (Leaf* leaf : leaves) {
      const Coord origin = leaf->origin() & ~(kBinSide - 1);
      const std::size_t bin =
          std::lower_bound(binAt_.begin(), binAt_.end(), std::make_pair(origin, std::size_t{0}))
              ->second;
      if (bins.empty() || bins.back().first != bin) bins.push_back({bin, {}});
      bins.back().second.push_back({leaf, {}, {}});
    }
    parallelForEach(bins.size(), 1, [&](std::size_t i) {
      progress_.check();
      correctBin(bins[i].first, bins[i].second, *works_.local());
    });
    std::vector<openvdb::CoordBBox> changes;
    for (const auto& [bin, changed] : bins)
      for (const NewLeaf& leaf : changed) {
        changes.push_back(changesOf(leaf));
        replace(leaf);
      }
    return changes;
  }

  /// A box around the voxels that had been active and have changed so much that they were near a
  /// hidden surface, which may go on beside them. Smaller changes are gaps between balls.
  openvdb::CoordBBox changesOf(const NewLeaf& changed) const {
    const float least = kLeastChange * voxelSize_;
    openvdb::CoordBBox box;
    const float* old = changed.leaf->buffer().data();
    for (auto voxel = changed.leaf->cbeginValueOn(); voxel; ++voxel)
      if (std::abs(changed.values[voxel.pos()] - old[voxel.pos()]) > least)
        box.expand(voxel.getCoord());
    return box;
  }

  /// Takes voxels out of the solid ones that a ball shows to be outside, though the surface is
  /// near. Their own balls count, too.
  void freeOutside(const std::vector<Leaf*>& leaves) {
    std::vector<std::array<std::uint64_t, 8>> free(leaves.size());
    parallelForEach(leaves.size(), 4, [&](std::size_t l) {
      progress_.check();
      freeOutside(*leaves[l], free[l], works_.local()->balls);
    });
    for (std::size_t l = 0; l < leaves.size(); ++l) {
      MaskLeaf* leaf = solid_.probeLeaf(leaves[l]->origin());
      if (leaf == nullptr) continue;
      auto mask = leaf->getValueMask();
      for (openvdb::Index x = 0; x < 8; ++x) mask.getWord<openvdb::Index64>(x) &= ~free[l][x];
      leaf->setValueMask(mask);
    }
  }

  void freeOutside(const Leaf& leaf, std::array<std::uint64_t, 8>& free, Balls& balls) const {
    free.fill(0);
    const MaskLeaf* const solidLeaf = solid_.probeConstLeaf(leaf.origin());
    if (solidLeaf == nullptr) return;
    balls.set(band_, solid_, leaf.origin(), voxelSize_);
    for (auto voxel = leaf.cbeginValueOn(); voxel; ++voxel) {
      const openvdb::Index i = voxel.pos();
      const float t = std::abs(*voxel) / voxelSize_;
      if (!solidLeaf->isValueOn(i) || t > kMostCrossed) continue;
      const Coord at = voxel.getCoord();
      const float overlapping = t < kUncovered ? kUncovered : t - kLeastOverlap;
      const bool isOutside = *voxel < 0 ? balls.neighboursHave(at, t - kLeastOverlapInside)
                                        : balls.hasNear(at, overlapping) ||
                                              balls.nearest(at, kMostCrossed) <= overlapping;
      free[i >> 6] |= std::uint64_t{isOutside} << (i & 63U);
    }
  }

  void correctBin(std::size_t bin, std::vector<NewLeaf>& leaves, Work& work) const {
    work.hidden.clear();
    for (std::size_t l = 0; l < leaves.size(); ++l) correctLeaf(l, leaves[l], work);
    if (work.hidden.empty()) return;
    for (auto& leaf : work.wanted.voxels) leaf.fill(0);
    for (auto& leaf : work.wanted.least) leaf.fill(0);
    work.wanted.leaves = 0;
    const auto numberOf = [&](const HiddenFoot& foot) {
      const Coord at = leaves[foot.leaf].leaf->origin() - bins_.originOf(bin);
      return leafOf(static_cast<unsigned>(at.x()), static_cast<unsigned>(at.y()),
                    static_cast<unsigned>(at.z()));
    };
    for (const HiddenFoot& foot : work.hidden) {
      work.wanted.leaves |= std::uint64_t{1} << numberOf(foot);
      work.wanted.voxels[numberOf(foot)][foot.voxel >> 6] |= std::uint64_t{1} << (foot.voxel & 63U);
      work.wanted.least[numberOf(foot)][foot.voxel] = keyOf(std::max(0.0F, foot.most - kUncovered));
    }
    work.brick.clear();
    scanCells(bins_, bins_.cellsOf(bin), false, &work.wanted, work.feet, work.brick);
    for (const HiddenFoot& foot : work.hidden) {
      const std::uint32_t key = work.brick.leaf(numberOf(foot))[foot.voxel];
      const float t = key == kNoKey ? foot.most : std::abs(distanceOf(key));
      setInside(leaves[foot.leaf], foot.voxel, std::min(t, foot.most));
    }
  }

  void correctLeaf(std::size_t number, NewLeaf& changed, Work& work) const {
    const Leaf& leaf = *changed.leaf;
    const Coord origin = leaf.origin();
    const MaskLeaf* const solidLeaf = solid_.probeConstLeaf(origin);
    std::copy_n(leaf.buffer().data(), changed.values.size(), changed.values.begin());
    changed.mask = leaf.getValueMask();
    work.balls.set(band_, solid_, origin, voxelSize_);
    for (openvdb::Index i = 0; i < Leaf::SIZE; ++i) {
      float& value = changed.values[i];
      const bool maybeInside = isSolid(solid_, solidLeaf, origin, i);
      if (!leaf.isValueOn(i)) {
        value = maybeInside ? -backgroundOf(options_.in, options_.voxelSize)
                            : backgroundOf(options_.out, options_.voxelSize);
        continue;
      }
      const float t = std::abs(value) / voxelSize_;
      const Coord voxel = leaf.offsetToGlobalCoord(i);
      if (!maybeInside) {
        value = std::abs(value);
        continue;
      }
      if (work.balls.hasNear(voxel, t + kUncovered)) {
        value = -std::abs(value);
        continue;
      }
      const auto deepest = static_cast<float>(options_.in) + kUncovered;
      const float most = work.balls.nearest(voxel, deepest);
      if (most <= t + kUncovered)
        value = -std::abs(value);
      else if (most >= deepest)
        setInside(changed, i, most);
      else
        work.hidden.push_back({number, i, most});
    }
  }

  /// @param t  voxels
  void setInside(NewLeaf& leaf, openvdb::Index voxel, float t) const {
    const float limit = backgroundOf(options_.in, options_.voxelSize);
    leaf.mask.set(voxel, t * voxelSize_ < limit);
    leaf.values[voxel] = -std::min(t * voxelSize_, limit);
  }

  /// Puts new values in the place of old ones; a tile where no voxel is active.
  void replace(const NewLeaf& changed) {
    if (changed.mask.isOff() &&
        std::all_of(changed.values.begin(), changed.values.end(),
                    [&](float value) { return value == changed.values[0]; })) {
      band_.addTile(1, changed.leaf->origin(), changed.values[0], false);
      return;
    }
    std::copy(changed.values.begin(), changed.values.end(), changed.leaf->buffer().data());
    changed.leaf->setValueMask(changed.mask);
  }

  openvdb::FloatTree& band_;
  const std::vector<Coord>& jumps_;
  const FootBins& bins_;
  openvdb::MaskTree& solid_;
  BandOptions options_;
  const Progress& progress_;
  float hidden_;  // world units
  float voxelSize_;
  std::vector<std::pair<Coord, std::size_t>> binAt_;  // origins of bins, sorted
  openvdb::MaskTree known_;                           // its leaves
  tbb::enumerable_thread_specific<std::unique_ptr<Work>> works_{
      [this] { return std::make_unique<Work>(options_.in); }};
};

}  // namespace

std::shared_ptr<openvdb::MaskTree> wallsOf(const openvdb::FloatTree& band, double voxelSize) {
  // Of two neighbours that the surface separates, one is nearer than the first, and if the other
  // one is on the inner side, that one is nearer than the second or this one than the first.
  const auto thin = static_cast<float>(kLeastOfFree * voxelSize);
  const auto thick = static_cast<float>(-0.9 * voxelSize);
  auto walls = std::make_shared<openvdb::MaskTree>(band, false, openvdb::TopologyCopy());
  std::vector<const Leaf*> leaves;
  std::vector<MaskLeaf*> masks;
  band.getNodes(leaves);
  walls->getNodes(masks);
  constexpr std::size_t kLeavesPerTask = 64;
  parallelForEach(leaves.size(), kLeavesPerTask, [&](std::size_t l) {
    const float* values = leaves[l]->buffer().data();
    auto mask = leaves[l]->getValueMask();
    for (openvdb::Index x = 0; x < 8; ++x) {
      std::uint64_t wall = 0;
      for (unsigned bit = 0; bit < 64; ++bit) {
        const float value = values[x << 6 | bit];
        wall |= std::uint64_t{value <= thin && value >= thick} << bit;
      }
      mask.getWord<openvdb::Index64>(x) &= wall;
    }
    masks[l]->setValueMask(mask);
  });
  return walls;
}

void expose(const Band& band, const FootBins& bins, openvdb::MaskTree& solid, double hidden,
            const BandOptions& options, const Progress& progress) {
  Exposure(band, bins, solid, hidden, options, progress).run();
}

}  // namespace vox
