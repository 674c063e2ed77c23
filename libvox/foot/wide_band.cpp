// Bands that grow from an exact band: nearest cells are handed on from voxel to voxel.

#include "libvox/foot/wide_band.h"

#include "libvox/core/parallel.h"
#include "libvox/core/progress.h"
#include "libvox/foot/nearest_feet.h"
#include "libvox/foot/scan_cell.h"
#include "libvox/grid/openvdb.h"

#include <openvdb/tools/ChangeBackground.h>
#include <openvdb/tools/Morphology.h>
#include <openvdb/tools/Prune.h>
#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <span>
#include <tuple>
#include <vector>

namespace vox {
namespace {

using openvdb::Coord;
using CellTree = openvdb::Int32Tree;
using FloatLeaf = openvdb::FloatTree::LeafNodeType;
using MaskLeaf = openvdb::MaskTree::LeafNodeType;

/// A voxel of a leaf that may have its foot in a cell.
struct Candidate {
  std::int32_t cell;    // of the bins
  std::uint16_t voxel;  // in the leaf
};

/// Of one thread.
struct WideWork {
  std::vector<Candidate> candidates;
  Feet feet;
  std::array<std::uint32_t, 512> keys;
  std::array<std::int32_t, 512> cells;
  std::array<float, 512> least;  // distances, by those of the neighbours
};

class BandWidener {
 public:
  BandWidener(openvdb::FloatTree& band, const FootBins& bins, const BandOptions& options,
              Progress& progress)
      : band_(band),
        bins_(bins),
        options_(options),
        progress_(progress),
        nearest_(kNoCell),
        voxelSize_(static_cast<float>(options.voxelSize)) {}

  /// Finds the nearest cells of the outermost voxels of the band.
  void begin(double exact) {
    constexpr double kShell = 2;  // voxels
    const auto limit = static_cast<float>((exact - kShell) * options_.voxelSize);
    for (auto leaf = band_.cbeginLeaf(); leaf; ++leaf) {
      MaskLeaf* mask = nullptr;
      for (auto value = leaf->cbeginValueOn(); value; ++value) {
        if (std::abs(*value) < limit) continue;
        if (mask == nullptr) mask = frontier_->touchLeaf(leaf->origin());
        mask->setValueOn(value.pos());
      }
      if (mask != nullptr) nearest_.touchLeaf(leaf->origin());
    }
    forEachFoot(bins_, *frontier_, progress_, 0, [&](const Coord& origin, const LeafFeet& feet) {
      auto* cells = nearest_.probeLeaf(origin)->buffer().data();
      feet.forEachFound([&](unsigned i) { cells[i] = bins_.indexOf(*feet.place[i].cell); });
    });
  }

  /// Adds the voxels that are at most `farthest` voxels from the surface.
  void grow(float farthest) {
    farthest_ = farthest;
    auto around = std::make_unique<openvdb::MaskTree>(*frontier_);
    openvdb::tools::dilateActiveValues(*around, 1, openvdb::tools::NN_FACE_EDGE_VERTEX);
    around->topologyUnion(*waiting_);
    around->topologyDifference(band_);
    waiting_ = std::make_unique<openvdb::MaskTree>(*around);
    std::vector<MaskLeaf*> leaves;
    around->getNodes(leaves);
    std::vector<FloatLeaf*> values;
    std::vector<CellTree::LeafNodeType*> cells;
    for (const MaskLeaf* leaf : leaves) {
      values.push_back(band_.touchLeaf(leaf->origin()));
      cells.push_back(nearest_.touchLeaf(leaf->origin()));
    }
    // Leaves whose voxels are all off do not change until all are done: their values are still
    // read.
    parallelForEach(leaves.size(), 1, [&](std::size_t l) {
      progress_.check();
      findNearest(*leaves[l], values[l]->buffer().data(), cells[l]->buffer().data());
    });
    parallelForEach(leaves.size(), 1, [&](std::size_t l) {
      auto mask = values[l]->getValueMask();
      mask |= leaves[l]->getValueMask();
      values[l]->setValueMask(mask);
    });
    openvdb::tools::pruneInactive(*around);
    waiting_->topologyDifference(*around);
    openvdb::tools::pruneInactive(*waiting_);
    frontier_ = std::move(around);
  }

 private:
  static constexpr std::int32_t kNoCell = -1;
  /// Distances change no more than the place, but for what they are off. So a foot that is nearer
  /// lies on a part that is hidden inside others.
  static constexpr float kSlack = 0.03F;  // voxels

  /// Sets distances and cells of new voxels; switches off those that are too far.
  void findNearest(MaskLeaf& leaf, float* values, std::int32_t* cells) {
    WideWork& work = *works_.local();
    collectCandidates(leaf, work);
    for (auto begin = work.candidates.begin(); begin != work.candidates.end();) {
      const auto end = std::find_if(begin, work.candidates.end(), [&](const Candidate& other) {
        return other.cell != begin->cell;
      });
      solve(leaf.origin(), {begin, end}, work);
      begin = end;
    }
    const auto thickness = static_cast<float>(options_.halfThickness);
    const auto out = static_cast<float>(options_.out), in = static_cast<float>(options_.in);
    openvdb::util::NodeMask<MaskLeaf::LOG2DIM> within;
    for (auto voxel = leaf.cbeginValueOn(); voxel; ++voxel) {
      const openvdb::Index i = voxel.pos();
      if (work.keys[i] == kNoKey) continue;
      const bool isInside = values[i] < 0;
      const float t = std::max(std::abs(distanceOf(work.keys[i])), work.least[i]);
      const float signedT = (isInside ? -t : t) - thickness;
      if (!(signedT < out && signedT > -in) || t > farthest_) continue;
      values[i] = signedT * voxelSize_;
      cells[i] = work.cells[i];
      within.setOn(i);
    }
    leaf.setValueMask(within);
  }

  /// The cells of the neighbours of each voxel, sorted by cells.
  void collectCandidates(const MaskLeaf& leaf, WideWork& work) const {
    work.candidates.clear();
    openvdb::tree::ValueAccessor<const openvdb::FloatTree> known(band_);
    openvdb::tree::ValueAccessor<const CellTree> nearest(nearest_);
    for (auto voxel = leaf.cbeginValueOn(); voxel; ++voxel) {
      work.keys[voxel.pos()] = kNoKey;
      work.least[voxel.pos()] = 0;
      const Coord at = voxel.getCoord();
      for (int i = 0; i < 27; ++i) {
        const Coord near = at.offsetBy(i / 9 - 1, i / 3 % 3 - 1, i % 3 - 1);
        float value = 0;
        if (!known.probeValue(near, value)) continue;
        const float t = std::abs(value / voxelSize_ + static_cast<float>(options_.halfThickness));
        float& least = work.least[voxel.pos()];
        least = std::max(least, t - static_cast<float>((near - at).asVec3d().length()) - kSlack);
        const std::int32_t cell = nearest.getValue(near);
        if (cell != kNoCell)
          work.candidates.push_back({cell, static_cast<std::uint16_t>(voxel.pos())});
      }
    }
    const auto order = [](const Candidate& c) { return std::make_tuple(c.cell, c.voxel); };
    std::sort(work.candidates.begin(), work.candidates.end(),
              [&](const Candidate& a, const Candidate& b) { return order(a) < order(b); });
    work.candidates.erase(
        std::unique(work.candidates.begin(), work.candidates.end(),
                    [&](const Candidate& a, const Candidate& b) { return order(a) == order(b); }),
        work.candidates.end());
  }

  /// @param candidates  of one cell
  void solve(const Coord& leafOrigin, std::span<const Candidate> candidates, WideWork& work) const {
    Feet& feet = work.feet;
    feet.count = candidates.size();
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      feet.x[i] = static_cast<float>(candidates[i].voxel >> 6);
      feet.y[i] = static_cast<float>(candidates[i].voxel >> 3 & 7);
      feet.z[i] = static_cast<float>(candidates[i].voxel & 7);
    }
    const BinnedCell& cell = bins_.cell(candidates[0].cell);
    if (cell.kind == CellKind::kNewton)
      solveFeet(bins_.newton(cell), leafOrigin, feet);
    else
      solveFeet(bins_.triangle(cell), leafOrigin, feet);
    for (std::size_t i = 0; i < candidates.size(); ++i) {
      const std::uint32_t key = keyOf(std::abs(feet.t[i]));
      if (key >= work.keys[candidates[i].voxel]) continue;
      work.keys[candidates[i].voxel] = key;
      work.cells[candidates[i].voxel] = candidates[i].cell;
    }
  }

  openvdb::FloatTree& band_;
  const FootBins& bins_;
  const BandOptions& options_;
  Progress& progress_;
  float farthest_ = 0;
  /// Voxels near the last ones that were too far: their nearest surface may not have come to them.
  std::unique_ptr<openvdb::MaskTree> waiting_ = std::make_unique<openvdb::MaskTree>();
  std::unique_ptr<openvdb::MaskTree> frontier_ = std::make_unique<openvdb::MaskTree>();
  CellTree nearest_;
  float voxelSize_;
  tbb::enumerable_thread_specific<std::unique_ptr<WideWork>> works_{
      [] { return std::make_unique<WideWork>(); }};
};

}  // namespace

void widen(openvdb::FloatTree& band, double exact, const FootBins& bins, const BandOptions& options,
           Progress& progress) {
  BandWidener widener(band, bins, options, progress);
  widener.begin(exact);
  const double last = std::max(options.in, options.out) + options.halfThickness;
  for (double farthest = exact + options.halfThickness; farthest < last;) {
    progress.check();
    farthest = std::min(farthest + 1, last);
    widener.grow(static_cast<float>(farthest));
  }
  openvdb::tools::changeAsymmetricLevelSetBackground(band,
                                                     backgroundOf(options.out, options.voxelSize),
                                                     -backgroundOf(options.in, options.voxelSize));
}

}  // namespace vox
