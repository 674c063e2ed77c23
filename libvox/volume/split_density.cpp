// A density as one tree for each label.

#include "libvox/volume/split_density.h"

#include "libvox/core/parallel.h"

#include <algorithm>
#include <memory>
#include <utility>

namespace vox {
namespace {

using openvdb::Coord;
using openvdb::Index;
using openvdb::Int32;
using DensityLeaf = openvdb::FloatTree::LeafNodeType;
using DensityLower = openvdb::FloatTree::RootNodeType::ChildNodeType::ChildNodeType;
using DensityUpper = openvdb::FloatTree::RootNodeType::ChildNodeType;
using LabelLeaf = openvdb::Int32Tree::LeafNodeType;

constexpr std::size_t kLeavesOfTask = 16;

/// The place of a leaf: the density there, and its labels.
struct Block {
  Coord origin;
  const DensityLeaf* density;  // null: all voxels are active, with the value
  float value;
  const LabelLeaf* labels;  // null: all voxels have the label
  Int32 label;

  bool isOn(Index i) const { return density == nullptr || density->isValueOn(i); }
  float valueAt(Index i) const { return density == nullptr ? value : density->getValue(i); }
  Int32 labelAt(Index i) const { return labels == nullptr ? label : labels->getValue(i); }

  /// The labels of its active voxels, ascending.
  std::vector<Int32> labelsOfVoxels() const {
    std::vector<Int32> found;
    for (Index i = 0; i < DensityLeaf::SIZE; ++i)
      if (isOn(i) && (found.empty() || found.back() != labelAt(i))) found.push_back(labelAt(i));
    std::sort(found.begin(), found.end());
    found.erase(std::unique(found.begin(), found.end()), found.end());
    return found;
  }
};

struct LabelledTile {
  Int32 label;
  Index level;
  Coord origin;
  float value;
};

/// Everything that a density consists of, in the order of the tree.
struct Pieces {
  std::vector<Block> blocks;
  std::vector<LabelledTile> tiles;
};

/// Adds a tile of a density, in parts of one label or of the size of a leaf.
void addTile(const openvdb::Int32Tree& labels, Index level, const Coord& origin, float value,
             Pieces& pieces) {
  const auto levelOfLabel = static_cast<Index>(static_cast<int>(openvdb::Int32Tree::DEPTH) - 1 -
                                               labels.getValueDepth(origin));
  const Int32 label = labels.getValue(origin);
  if (levelOfLabel >= level) return pieces.tiles.push_back({label, level, origin, value});
  if (level == 1)
    return pieces.blocks.push_back({origin, nullptr, value, labels.probeConstLeaf(origin), label});
  const bool isLargest = level == DensityUpper::LEVEL + 1;
  const int side = static_cast<int>(isLargest ? DensityUpper::DIM : DensityLower::DIM);
  const int step = static_cast<int>(isLargest ? DensityLower::DIM : DensityLeaf::DIM);
  for (int x = 0; x < side; x += step)
    for (int y = 0; y < side; y += step)
      for (int z = 0; z < side; z += step)
        addTile(labels, level - 1, origin.offsetBy(x, y, z), value, pieces);
}

Pieces piecesOf(const openvdb::FloatTree& density, const openvdb::Int32Tree& labels) {
  Pieces pieces;
  std::vector<const DensityLeaf*> leaves;
  density.getNodes(leaves);
  for (const DensityLeaf* leaf : leaves)
    pieces.blocks.push_back({leaf->origin(), leaf, 0, labels.probeConstLeaf(leaf->origin()),
                             labels.getValue(leaf->origin())});
  auto tile = density.cbeginValueOn();
  tile.setMaxDepth(openvdb::FloatTree::ValueOnCIter::LEAF_DEPTH - 1);
  for (; tile; ++tile) addTile(labels, tile.getLevel(), tile.getBoundingBox().min(), *tile, pieces);
  return pieces;
}

/// The voxels of a block with a label.
struct LabelledLeaf {
  Int32 label;
  std::unique_ptr<DensityLeaf> leaf;
};

std::vector<LabelledLeaf> leavesOf(const Block& block) {
  constexpr float kBackground = 0;
  const std::vector<Int32> labels = block.labelsOfVoxels();
  std::vector<LabelledLeaf> leaves;
  for (const Int32 label : labels)
    leaves.push_back({label, std::make_unique<DensityLeaf>(block.origin, kBackground)});
  for (Index i = 0; i < DensityLeaf::SIZE; ++i) {
    if (!block.isOn(i)) continue;
    const auto slot = std::lower_bound(labels.begin(), labels.end(), block.labelAt(i));
    leaves[static_cast<std::size_t>(slot - labels.begin())].leaf->setValueOn(i, block.valueAt(i));
  }
  return leaves;
}

/// What one label has of a density.
struct PiecesOfLabel {
  std::vector<std::unique_ptr<DensityLeaf>> leaves;
  std::vector<const LabelledTile*> tiles;
};

openvdb::FloatTree::Ptr treeOf(PiecesOfLabel& pieces) {
  if (pieces.leaves.empty() && pieces.tiles.empty()) return nullptr;
  auto tree = std::make_shared<openvdb::FloatTree>(0.0F);
  for (const LabelledTile* tile : pieces.tiles)
    tree->addTile(tile->level, tile->origin, tile->value, /*state=*/true);
  for (auto& leaf : pieces.leaves) tree->addLeaf(leaf.release());
  return tree;
}

}  // namespace

std::vector<openvdb::FloatTree::Ptr> splitDensity(const openvdb::FloatTree& density,
                                                  const openvdb::Int32Tree& labels,
                                                  std::size_t count) {
  const Pieces pieces = piecesOf(density, labels);
  std::vector<std::vector<LabelledLeaf>> leaves(pieces.blocks.size());
  parallelForEach(leaves.size(), kLeavesOfTask,
                  [&](std::size_t i) { leaves[i] = leavesOf(pieces.blocks[i]); });
  std::vector<PiecesOfLabel> ofLabels(count);
  const auto ofLabel = [&](Int32 label) -> PiecesOfLabel& {
    return ofLabels.at(static_cast<std::size_t>(label) - 1);
  };
  for (auto& ofBlock : leaves)
    for (LabelledLeaf& one : ofBlock) ofLabel(one.label).leaves.push_back(std::move(one.leaf));
  for (const LabelledTile& tile : pieces.tiles) ofLabel(tile.label).tiles.push_back(&tile);
  std::vector<openvdb::FloatTree::Ptr> trees(count);
  parallelForEach(count, 1, [&](std::size_t i) { trees[i] = treeOf(ofLabels[i]); });
  return trees;
}

std::uint64_t bytesOfSplitting(const openvdb::FloatTree& density, const openvdb::Int32Tree& labels,
                               std::size_t count) {
  const Pieces pieces = piecesOf(density, labels);
  std::vector<std::vector<Int32>> ofBlocks(pieces.blocks.size());
  parallelForEach(ofBlocks.size(), kLeavesOfTask,
                  [&](std::size_t i) { ofBlocks[i] = pieces.blocks[i].labelsOfVoxels(); });
  constexpr std::uint64_t kLeaf = sizeof(DensityLeaf) + DensityLeaf::SIZE * sizeof(float) +
                                  sizeof(LabelledLeaf) + sizeof(Block);
  std::vector<Coord> lastLower(count, Coord::max());
  std::vector<Coord> lastUpper(count, Coord::max());
  std::uint64_t bytes = 0;
  const auto addNodes = [&](Int32 label, const Coord& origin) {
    constexpr int kLower = static_cast<int>(DensityLower::DIM);
    constexpr int kUpper = static_cast<int>(DensityUpper::DIM);
    const auto i = static_cast<std::size_t>(label) - 1;
    if (std::exchange(lastLower.at(i), origin & ~(kLower - 1)) != (origin & ~(kLower - 1)))
      bytes += sizeof(DensityLower);
    if (std::exchange(lastUpper[i], origin & ~(kUpper - 1)) != (origin & ~(kUpper - 1)))
      bytes += sizeof(DensityUpper);
  };
  for (std::size_t b = 0; b < ofBlocks.size(); ++b)
    for (const Int32 label : ofBlocks[b]) {
      bytes += kLeaf;
      addNodes(label, pieces.blocks[b].origin);
    }
  for (const LabelledTile& tile : pieces.tiles) addNodes(tile.label, tile.origin);
  return bytes;
}

}  // namespace vox
