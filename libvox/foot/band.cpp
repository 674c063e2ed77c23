// A band of distances: bin by bin the least key of all cells, then leaves, then their tree.

#include "libvox/foot/band.h"

#include "libvox/core/parallel.h"
#include "libvox/core/progress.h"
#include "libvox/foot/scan_cell.h"
#include "libvox/grid/enclosed.h"
#include "libvox/grid/leaf_words.h"
#include "libvox/grid/openvdb.h"

#include <openvdb/tools/SignedFloodFill.h>
#include <tbb/enumerable_thread_specific.h>
#include <tbb/spin_mutex.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <bit>
#include <cmath>
#include <deque>
#include <limits>
#include <map>
#include <vector>

namespace vox {
namespace {

using Tree = openvdb::FloatTree;
using Leaf = Tree::LeafNodeType;
using Upper = Tree::RootNodeType::ChildNodeType;
using Lower = Upper::ChildNodeType;

/// A lower node that several tasks fill.
struct Page {
  tbb::spin_mutex lock;
  Lower* node = nullptr;
};

struct LeafSigns {
  LeafWords active, inside;

  bool anyActive() const {
    std::uint64_t any = 0;
    for (const std::uint64_t word : active) any |= word;
    return any != 0;
  }
};

/// The negative active voxels, and the inactive ones inside: those that negative ones reach. Signs
/// of active voxels next to inactive ones are right.
LeafWords withInactive(const LeafWords& active, const LeafWords& negative) {
  std::uint64_t some = 0, others = 0;
  for (std::size_t x = 0; x < 8; ++x) {
    some |= negative[x];
    others |= active[x] & ~negative[x];
  }
  LeafWords inside = {};
  if (some == 0) return inside;
  inside.fill(~std::uint64_t{0});
  if (others == 0) return inside;
  inside = flooded(neighboursOf(negative), complementOf(active));
  for (std::size_t x = 0; x < 8; ++x) inside[x] |= negative[x];
  return inside;
}

/// The active voxels of a leaf of a mask.
LeafWords bitsOf(const openvdb::MaskTree& mask, const openvdb::Coord& origin) {
  if (const auto* leaf = mask.probeConstLeaf(origin)) return activeWords(*leaf);
  LeafWords bits;
  bits.fill(mask.isValueOn(origin) ? ~std::uint64_t{0} : 0);
  return bits;
}

class BandMaker {
 public:
  BandMaker(const FootBins& bins, const BandOptions& options, const Inside& inside)
      : bins_(bins),
        options_(options),
        inside_(inside),
        voxelSize_(static_cast<float>(options.voxelSize)),
        background_(backgroundOf(options.out, options.voxelSize)),
        insideBackground_(backgroundOf(options.in, options.voxelSize)),
        mostOut_(keyOf(static_cast<float>(options.out + options.halfThickness))),
        mostIn_(keyOf(static_cast<float>(options.in + options.halfThickness))),
        pageOf_(bins.count()) {
    std::map<openvdb::Coord, Page*> known;
    for (std::size_t bin = 0; bin < bins.count(); ++bin) {
      const openvdb::Coord origin = bins.originOf(bin) & ~(static_cast<int>(Lower::DIM) - 1);
      Page*& page = known[origin];
      if (page == nullptr) page = &pages_.emplace_back();
      pageOf_[bin] = page;
    }
  }

  ~BandMaker() {
    for (Page& page : pages_) delete page.node;
  }
  BandMaker(const BandMaker&) = delete;
  BandMaker& operator=(const BandMaker&) = delete;

  void run(Progress& progress, double share) {
    tbb::enumerable_thread_specific<std::unique_ptr<Work>> works(
        [] { return std::make_unique<Work>(); });
    const double part = share / static_cast<double>(std::max<std::size_t>(1, bins_.count()));
    parallelForEach(bins_.count(), 1, [&](std::size_t bin) {
      progress.check();
      Work& work = *works.local();
      scanBin(bin, work);
      finishBin(bin, work);
      progress.done(part);
    });
    for (const auto& work : works) jumps_ += work->jumps;
  }

  Band take() {
    auto tree = std::make_shared<Tree>(background_);
    for (Page& page : pages_) {
      if (page.node == nullptr) continue;
      auto* upper = tree->probeNode<Upper>(page.node->origin());
      if (upper == nullptr) {
        upper = new Upper(page.node->origin(), background_, false);
        tree->root().addChild(upper);
      }
      upper->addChild(page.node);
      page.node = nullptr;
    }
    if (!options_.unsignedDistance)
      openvdb::tools::signedFloodFillWithValues(*tree, background_, -insideBackground_, true, 1, 1);
    return {tree, jumps_};
  }

 private:
  /// Of one thread.
  struct Work {
    FootBrick brick, ofGroup;
    Feet feet;
    std::vector<Leaf*> leaves;
    std::uint64_t jumps = 0;
  };

  /// Scans the cells of a bin, group by group.
  void scanBin(std::size_t bin, Work& work) const {
    work.brick.clear();
    const auto cells = bins_.cellsOf(bin);
    for (auto begin = cells.begin(); begin != cells.end();) {
      const auto end = std::find_if(
          begin, cells.end(), [&](const BinnedCell& cell) { return cell.group != begin->group; });
      const bool isFirst = begin == cells.begin();
      FootBrick& brick = isFirst ? work.brick : work.ofGroup;
      if (!isFirst) brick.clear();
      for (; begin != end; ++begin) scanCell(*begin, bins_.originOf(bin), work.feet, brick);
      if (!isFirst) work.brick.unite(brick);
    }
  }

  void scanCell(const BinnedCell& cell, const openvdb::Coord& origin, Feet& feet,
                FootBrick& brick) const {
    const auto keep = [&](const Feet& found) { keepLeast(found, brick); };
    switch (cell.kind) {
      case CellKind::kNewton:
        return scanFeet(bins_.newton(cell), origin, nullptr, feet, keep);
      case CellKind::kPolynomial:
        return scanPolynomials(bins_.polynomial(cell), origin, options_.unsignedDistance, brick);
      case CellKind::kTriangle:
      case CellKind::kRibbon:
        return scanFeet(bins_.triangle(cell), origin, nullptr, feet, keep);
    }
  }

  void keepLeast(const Feet& feet, FootBrick& brick) const {
    for (std::size_t i = 0; i < feet.count; ++i) {
      const auto x = static_cast<unsigned>(feet.x[i]), y = static_cast<unsigned>(feet.y[i]),
                 z = static_cast<unsigned>(feet.z[i]);
      std::uint32_t& least = brick.leaf(leafOf(x, y, z))[voxelInLeaf(x, y, z)];
      const float t = feet.t[i];
      least = std::min(least, keyOf(options_.unsignedDistance ? std::abs(t) : t));
    }
  }

  void finishBin(std::size_t bin, Work& work) {
    work.leaves.clear();
    const openvdb::Coord origin = bins_.originOf(bin);
    for (std::uint64_t left = work.brick.touched(); left != 0; left &= left - 1) {
      const auto number = static_cast<unsigned>(std::countr_zero(left));
      Leaf* leaf = makeLeaf(work.brick.leaf(number), FootBrick::leafOrigin(origin, number), work);
      if (leaf != nullptr) work.leaves.push_back(leaf);
    }
    if (work.leaves.empty()) return;
    Page& page = *pageOf_[bin];
    const tbb::spin_mutex::scoped_lock lock(page.lock);
    if (page.node == nullptr) page.node = new Lower(origin, background_, false);
    for (Leaf* leaf : work.leaves) page.node->addLeaf(leaf);
  }

  /// The leaf of some keys; null if no voxel is active.
  Leaf* makeLeaf(const std::uint32_t* keys, const openvdb::Coord& origin, Work& work) const {
    const LeafSigns signs =
        inside_.solid == nullptr ? signsByFeet(keys, work) : signsByVoxels(keys, origin);
    if (!signs.anyActive()) return nullptr;
    auto* leaf = new Leaf(openvdb::PartialCreate(), origin, background_, false);
    leaf->allocate();
    float* values = leaf->buffer().data();
    openvdb::util::NodeMask<Leaf::LOG2DIM> mask;
    const auto thickness = static_cast<float>(options_.halfThickness);
    for (unsigned x = 0; x < 8; ++x) {
      mask.getWord<openvdb::Index64>(x) = signs.active[x];
      for (unsigned bit = 0; bit < 64; ++bit) {
        const bool isInside = (signs.inside[x] >> bit & 1U) != 0;
        const float t = std::abs(distanceOf(keys[x << 6 | bit]));
        const float near = ((isInside ? -t : t) - thickness) * voxelSize_;
        const float far = isInside ? -insideBackground_ : background_;
        values[x << 6 | bit] = (signs.active[x] >> bit & 1U) != 0 ? near : far;
      }
    }
    leaf->setValueMask(mask);
    return leaf;
  }

  LeafSigns signsByFeet(const std::uint32_t* keys, Work& work) const {
    LeafSigns signs = {};
    LeafWords negative = {};
    for (unsigned x = 0; x < 8; ++x)
      for (unsigned bit = 0; bit < 64; ++bit) {
        const std::uint32_t key = keys[x << 6 | bit];
        const std::uint64_t minus = key & 1U;
        const std::uint64_t active = key < (minus != 0 ? mostIn_ : mostOut_) ? 1 : 0;
        signs.active[x] |= active << bit;
        negative[x] |= (active & minus) << bit;
      }
    if (options_.unsignedDistance) return signs;
    work.jumps += jumpsOf(keys, signs.active, negative);
    signs.inside = withInactive(signs.active, negative);
    return signs;
  }

  LeafSigns signsByVoxels(const std::uint32_t* keys, const openvdb::Coord& origin) const {
    constexpr float kNear = 1;  // a surface that crosses the voxel is nearer than this
    const std::uint32_t nearest = keyOf(kNear);
    const LeafWords surface = bitsOf(*inside_.surface, origin);
    LeafSigns signs = {};
    signs.inside = bitsOf(*inside_.solid, origin);
    const openvdb::tree::ValueAccessor<const openvdb::MaskTree> solid(*inside_.solid);
    for (unsigned x = 0; x < 8; ++x)
      for (unsigned bit = 0; bit < 64; ++bit) {
        const std::uint32_t key = keys[x << 6 | bit];
        const std::uint64_t one = std::uint64_t{1} << bit;
        const bool maybeOutside = (surface[x] & one) != 0 && key < nearest && (key & 1U) == 0;
        if (maybeOutside &&
            !isEnclosed(solid, origin.offsetBy(static_cast<int>(x), static_cast<int>(bit >> 3),
                                               static_cast<int>(bit & 7U))))
          signs.inside[x] &= ~one;
        if (key < ((signs.inside[x] & one) != 0 ? mostIn_ : mostOut_)) signs.active[x] |= one;
      }
    return signs;
  }

  /// Number of neighbouring voxels in the leaf that no surface separates as their distances say.
  static std::uint64_t jumpsOf(const std::uint32_t* keys, const LeafWords& active,
                               const LeafWords& negative) {
    constexpr float kMost = 1.02F;
    constexpr std::uint64_t kNotLastZ = 0x7F7F7F7F7F7F7F7F;
    std::uint64_t jumps = 0;
    const auto count = [&](unsigned x, std::uint64_t pairs, unsigned step) {
      for (; pairs != 0; pairs &= pairs - 1) {
        const unsigned at = x << 6 | static_cast<unsigned>(std::countr_zero(pairs));
        const float sum = std::abs(distanceOf(keys[at])) + std::abs(distanceOf(keys[at + step]));
        if (sum > kMost) ++jumps;
      }
    };
    for (unsigned x = 0; x < 8; ++x) {
      const std::uint64_t a = active[x], n = negative[x];
      count(x, (n ^ n >> 1) & a & a >> 1 & kNotLastZ, 1);
      count(x, (n ^ n >> 8) & a & a >> 8 & ~(std::uint64_t{0xFF} << 56), 8);
      if (x < 7) count(x, (n ^ negative[x + 1]) & a & active[x + 1], 64);
    }
    return jumps;
  }

  const FootBins& bins_;
  BandOptions options_;
  Inside inside_;
  float voxelSize_;
  float background_, insideBackground_;
  std::uint32_t mostOut_, mostIn_;  // keys of active voxels are smaller
  std::deque<Page> pages_;
  std::vector<Page*> pageOf_;  // of each bin
  std::uint64_t jumps_ = 0;
};

}  // namespace

Band makeBand(const FootBins& bins, const BandOptions& options, const Inside& inside,
              Progress& progress, double part) {
  BandMaker maker(bins, options, inside);
  maker.run(progress, part);
  return maker.take();
}

float backgroundOf(double width, double voxelSize) {
  // OpenVDB refuses a band a little below 3 voxels as too narrow.
  const double exact = width * voxelSize;
  const auto nearest = static_cast<float>(exact);
  return double{nearest} < exact ? std::nextafter(nearest, std::numeric_limits<float>::max())
                                 : nearest;
}

}  // namespace vox
