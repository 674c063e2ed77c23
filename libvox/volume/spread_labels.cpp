// Labels of voxels inside, from those of the surface.

#include "libvox/volume/spread_labels.h"

#include "libvox/core/parallel.h"
#include "libvox/core/progress.h"

#include <openvdb/tree/LeafManager.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <unordered_map>
#include <utility>
#include <vector>

namespace vox {
namespace {

using LabelTree = openvdb::Int32Tree;
using LabelLeaf = LabelTree::LeafNodeType;
using openvdb::Coord;

constexpr int kLeafSide = 8;
constexpr int kLabelBlockSide = kLeafSide + 2;

/// The values of a leaf and of the voxels around it; 0 where there is no leaf.
class LabelBlock {
 public:
  LabelBlock(const LabelTree& tree, const LabelLeaf& leaf) {
    const openvdb::tree::ValueAccessor<const LabelTree> accessor(tree);
    for (int x = -1; x <= 1; ++x)
      for (int y = -1; y <= 1; ++y)
        for (int z = -1; z <= 1; ++z) {
          const LabelLeaf* const from = x == 0 && y == 0 && z == 0
                                            ? &leaf
                                            : accessor.probeConstLeaf(leaf.origin().offsetBy(
                                                  kLeafSide * x, kLeafSide * y, kLeafSide * z));
          if (from != nullptr) copy(*from, {x, y, z});
        }
  }

  /// The voxels of the leaf that have a value, or a neighbour with one: as many bits as a row of
  /// them has voxels, for each x and y. A cheap test before a costly search.
  std::array<std::uint8_t, kLeafSide * kLeafSide> nearValues() const {
    std::array<std::uint16_t, kLabelBlockSide * kLabelBlockSide> rows{};
    for (std::size_t i = 0; i < values_.size(); ++i)
      if (values_[i] != 0)
        rows[i / kLabelBlockSide] |= static_cast<std::uint16_t>(1U << (i % kLabelBlockSide));
    std::array<std::uint8_t, kLeafSide * kLeafSide> near{};
    for (std::size_t x = 0; x < kLeafSide; ++x)
      for (std::size_t y = 0; y < kLeafSide; ++y) {
        unsigned row = 0;
        for (std::size_t a = x; a < x + 3; ++a)
          for (std::size_t b = y; b < y + 3; ++b) row |= rows[a * kLabelBlockSide + b];
        near[x * kLeafSide + y] = static_cast<std::uint8_t>(row | row >> 1U | row >> 2U);
      }
    return near;
  }

  /// Of a voxel whose coordinates in the leaf are -1 to 8.
  std::int32_t at(int x, int y, int z) const { return values_[indexOf(x, y, z)]; }

 private:
  static std::size_t indexOf(int x, int y, int z) {
    return static_cast<std::size_t>(((x + 1) * kLabelBlockSide + y + 1) * kLabelBlockSide + z + 1);
  }
  /// Copies what a neighbour has beside the leaf.
  void copy(const LabelLeaf& from, const std::array<int, 3>& step) {
    const auto low = [&](std::size_t axis) { return step[axis] < 0 ? kLeafSide - 1 : 0; };
    const auto high = [&](std::size_t axis) { return step[axis] > 0 ? 0 : kLeafSide - 1; };
    const LabelLeaf::ValueType* const values = from.buffer().data();
    for (int x = low(0); x <= high(0); ++x)
      for (int y = low(1); y <= high(1); ++y)
        for (int z = low(2); z <= high(2); ++z)
          values_[indexOf(x + kLeafSide * step[0], y + kLeafSide * step[1],
                          z + kLeafSide * step[2])] = values[(x * kLeafSide + y) * kLeafSide + z];
  }

  std::array<std::int32_t, kLabelBlockSide * kLabelBlockSide * kLabelBlockSide> values_{};
};

std::int64_t squaredDistance(const Coord& a, const Coord& b) {
  const Coord d = a - b;
  return std::int64_t{d.x()} * d.x() + std::int64_t{d.y()} * d.y() + std::int64_t{d.z()} * d.z();
}

/// The nearest of the sources of the neighbours of a voxel; 0 if they have none.
std::int32_t nearestSource(const LabelBlock& block, const std::vector<Coord>& sources,
                           const Coord& inLeaf, const Coord& voxel) {
  std::int32_t nearest = 0;
  auto least = std::numeric_limits<std::int64_t>::max();
  for (int x = -1; x <= 1; ++x)
    for (int y = -1; y <= 1; ++y)
      for (int z = -1; z <= 1; ++z) {
        const std::int32_t source = block.at(inLeaf.x() + x, inLeaf.y() + y, inLeaf.z() + z);
        if (source == 0 || source == nearest) continue;
        const std::int64_t distance =
            squaredDistance(voxel, sources[static_cast<std::size_t>(source - 1)]);
        if (distance > least || (distance == least && source > nearest)) continue;
        least = distance;
        nearest = source;
      }
  return nearest;
}

/// Values of inactive voxels are 0, so that they are no sources.
using FoundLabels = std::vector<std::pair<openvdb::Index, std::int32_t>>;

FoundLabels foundIn(const LabelTree& tree, const LabelLeaf& leaf,
                    const std::vector<Coord>& sources) {
  FoundLabels found;
  const LabelBlock block(tree, leaf);
  const auto near = block.nearValues();
  for (auto voxel = leaf.cbeginValueOn(); voxel; ++voxel) {
    if (*voxel != 0 || (near[voxel.pos() / kLeafSide] >> (voxel.pos() % kLeafSide) & 1U) == 0)
      continue;
    const std::int32_t source =
        nearestSource(block, sources, LabelLeaf::offsetToLocalCoord(voxel.pos()), voxel.getCoord());
    if (source != 0) found.emplace_back(voxel.pos(), source);
  }
  return found;
}

bool hasUnlabelled(const LabelLeaf& leaf) {
  for (auto voxel = leaf.cbeginValueOn(); voxel; ++voxel)
    if (*voxel == 0) return true;
  return false;
}

/// The numbers of leaves.
class LeafNumbers {
 public:
  explicit LeafNumbers(const openvdb::tree::LeafManager<LabelTree>& leaves) {
    for (std::size_t n = 0; n < leaves.leafCount(); ++n)
      numbers_.emplace(leaves.leaf(n).origin(), n);
  }
  /// Appends the numbers of a leaf and of those around it.
  void addAround(const Coord& origin, std::vector<std::size_t>& numbers) const {
    for (int x = -kLeafSide; x <= kLeafSide; x += kLeafSide)
      for (int y = -kLeafSide; y <= kLeafSide; y += kLeafSide)
        for (int z = -kLeafSide; z <= kLeafSide; z += kLeafSide) {
          const auto found = numbers_.find(origin.offsetBy(x, y, z));
          if (found != numbers_.end()) numbers.push_back(found->second);
        }
  }

 private:
  std::unordered_map<Coord, std::size_t> numbers_;
};

}  // namespace

void spreadLabels(LabelTree& labels, const Progress& progress) {
  openvdb::tree::LeafManager<LabelTree> leaves(labels);
  std::vector<Coord> sources;  // of each labelled voxel
  std::vector<std::int32_t> labelOf;
  std::vector<std::size_t> open;  // leaves with voxels that no label has reached
  for (std::size_t n = 0; n < leaves.leafCount(); ++n) {
    LabelLeaf& leaf = leaves.leaf(n);
    if (hasUnlabelled(leaf)) open.push_back(n);
    for (auto voxel = leaf.beginValueOn(); voxel; ++voxel) {
      if (*voxel == 0) continue;
      sources.push_back(voxel.getCoord());
      labelOf.push_back(*voxel);
      voxel.setValue(static_cast<std::int32_t>(sources.size()));
    }
  }
  const LeafNumbers numbers(leaves);
  while (!open.empty()) {
    progress.check();
    std::vector<FoundLabels> found(open.size());
    parallelForEach(open.size(), 1, [&](std::size_t i) {
      found[i] = foundIn(labels, leaves.leaf(open[i]), sources);
    });
    std::vector<std::size_t> next;  // leaves beside labels that are new
    for (std::size_t i = 0; i < open.size(); ++i) {
      if (found[i].empty()) continue;
      LabelLeaf& leaf = leaves.leaf(open[i]);
      for (const auto& [at, source] : found[i]) leaf.setValueOnly(at, source);
      numbers.addAround(leaf.origin(), next);
    }
    std::sort(next.begin(), next.end());
    next.erase(std::unique(next.begin(), next.end()), next.end());
    std::erase_if(next, [&](std::size_t n) { return !hasUnlabelled(leaves.leaf(n)); });
    open = std::move(next);
  }
  parallelForEach(leaves.leafCount(), 1, [&](std::size_t n) {
    for (auto voxel = leaves.leaf(n).beginValueOn(); voxel; ++voxel)
      if (*voxel != 0) voxel.setValue(labelOf[static_cast<std::size_t>(*voxel - 1)]);
  });
}

}  // namespace vox
