// A band of distances: bin by bin the least key of all cells, then leaves, then their tree.

#include "libvox/foot/band.h"

#include "libvox/core/parallel.h"
#include "libvox/core/progress.h"
#include "libvox/foot/band_holes.h"
#include "libvox/foot/scan_bin.h"
#include "libvox/grid/leaf_words.h"
#include "libvox/grid/openvdb.h"

#include <openvdb/tools/ChangeBackground.h>
#include <openvdb/tools/Prune.h>
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

class BandMaker {
 public:
  BandMaker(const FootBins& bins, const BandOptions& options)
      : bins_(bins),
        options_(options),
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
      work.brick.clear();
      scanCells(bins_, bins_.cellsOf(bin), options_.unsignedDistance, nullptr, work.feet,
                work.brick);
      finishBin(bin, work);
      progress.done(part);
    });
    for (const auto& work : works)
      jumps_.insert(jumps_.end(), work->jumps.begin(), work->jumps.end());
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
    const bool hadHoles = closeHoles(*tree, options_) > 0;
    if (!options_.unsignedDistance) {
      const openvdb::Index lowest = hadHoles ? 0 : 1;  // levels of the tree; 0: the leaves, too
      if (options_.isPart)
        floodPages(*tree, lowest);
      else
        openvdb::tools::signedFloodFillWithValues(*tree, background_, -insideBackground_, true, 1,
                                                  lowest);
    }
    return {tree, jumps_};
  }

 private:
  /// Of one thread.
  struct Work {
    FootBrick brick;
    Feet feet;
    std::vector<Leaf*> leaves;
    std::vector<openvdb::Coord> jumps;
  };

  /// The flood of signs within each lower node.
  void floodPages(Tree& tree, openvdb::Index lowest) const {
    const openvdb::tools::SignedFloodFillOp<Tree> flood(background_, -insideBackground_, lowest);
    std::vector<Lower*> pages;
    tree.getNodes(pages);
    parallelForEach(pages.size(), 1, [&](std::size_t i) {
      if (lowest == 0)
        for (auto leaf = pages[i]->beginChildOn(); leaf; ++leaf) flood(*leaf);
      flood(*pages[i]);
    });
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
    const LeafSigns signs = signsOf(keys, origin, work);
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

  LeafSigns signsOf(const std::uint32_t* keys, const openvdb::Coord& origin, Work& work) const {
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
    if (hasJump(keys, signs.active, negative)) work.jumps.push_back(origin);
    signs.inside = withInactive(signs.active, negative);
    return signs;
  }

  /// Whether neighbouring voxels in the leaf are not separated by a surface as their distances say.
  static bool hasJump(const std::uint32_t* keys, const LeafWords& active,
                      const LeafWords& negative) {
    constexpr float kMost = 1.02F;
    constexpr std::uint64_t kNotLastZ = 0x7F7F7F7F7F7F7F7F;
    const auto any = [&](unsigned x, std::uint64_t pairs, unsigned step) {
      for (; pairs != 0; pairs &= pairs - 1) {
        const unsigned at = x << 6 | static_cast<unsigned>(std::countr_zero(pairs));
        if (std::abs(distanceOf(keys[at])) + std::abs(distanceOf(keys[at + step])) > kMost)
          return true;
      }
      return false;
    };
    for (unsigned x = 0; x < 8; ++x) {
      const std::uint64_t a = active[x], n = negative[x];
      if (any(x, (n ^ n >> 1) & a & a >> 1 & kNotLastZ, 1) ||
          any(x, (n ^ n >> 8) & a & a >> 8 & ~(std::uint64_t{0xFF} << 56), 8) ||
          (x < 7 && any(x, (n ^ negative[x + 1]) & a & active[x + 1], 64)))
        return true;
    }
    return false;
  }

  const FootBins& bins_;
  BandOptions options_;
  float voxelSize_;
  float background_, insideBackground_;
  std::uint32_t mostOut_, mostIn_;  // keys of active voxels are smaller
  std::deque<Page> pages_;
  std::vector<Page*> pageOf_;  // of each bin
  std::vector<openvdb::Coord> jumps_;
};

}  // namespace

Band makeBand(const FootBins& bins, const BandOptions& options, Progress& progress, double part) {
  BandMaker maker(bins, options);
  maker.run(progress, part);
  return maker.take();
}

void trim(openvdb::FloatTree& band, const BandOptions& options) {
  const float out = backgroundOf(options.out, options.voxelSize);
  const float in = backgroundOf(options.in, options.voxelSize);
  std::vector<Leaf*> leaves;
  band.getNodes(leaves);
  constexpr std::size_t kLeavesPerTask = 64;
  parallelForEach(leaves.size(), kLeavesPerTask, [&](std::size_t l) {
    float* values = leaves[l]->buffer().data();
    auto mask = leaves[l]->getValueMask();
    for (openvdb::Index i = 0; i < Leaf::SIZE; ++i) {
      if (values[i] > -in && values[i] < out) continue;
      values[i] = values[i] < 0 ? -in : out;
      mask.setOff(i);
    }
    leaves[l]->setValueMask(mask);
  });
  openvdb::tools::changeAsymmetricLevelSetBackground(band, out, -in);
  openvdb::tools::pruneLevelSet(band, out, -in);
}

float backgroundOf(double width, double voxelSize) {
  // OpenVDB refuses a band a little below 3 voxels as too narrow.
  const double exact = width * voxelSize;
  const auto nearest = static_cast<float>(exact);
  return double{nearest} < exact ? std::nextafter(nearest, std::numeric_limits<float>::max())
                                 : nearest;
}

}  // namespace vox
