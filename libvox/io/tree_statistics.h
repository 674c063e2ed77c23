#pragma once

#include "libvox/core/parallel.h"
#include "libvox/grid/leaf_words.h"
#include "libvox/grid/openvdb.h"

#include <mutex>
#include <vector>

namespace vox {

/// What OpenVDB writes into the metadata of a grid about its tree, as its own functions define it.
struct TreeStatistics {
  openvdb::CoordBBox box;  ///< of the active voxels and tiles
  openvdb::Index64 activeVoxels = 0;
  openvdb::Index64 bytes = 0;  ///< of memory, with all values loaded

  void add(const TreeStatistics& other) {
    box.expand(other.box);
    activeVoxels += other.activeVoxels;
    bytes += other.bytes;
  }
};

template <class Leaf>
void addLeaf(const Leaf& leaf, TreeStatistics& to) {
  const LeafWords voxels = activeWords(leaf);
  const std::uint64_t count = countOf(voxels);
  to.activeVoxels += count;
  to.bytes += leaf.memUsageIfLoaded();
  if (count == 0 || to.box.isInside(leaf.getNodeBoundingBox())) return;
  const LeafBox box = boxOf(voxels);
  to.box.expand({leaf.origin().offsetBy(box.low[0], box.low[1], box.low[2]),
                 leaf.origin().offsetBy(box.high[0], box.high[1], box.high[2])});
}

/// Adds the active tiles of a node.
template <class Node>
void addTiles(const Node& node, TreeStatistics& to) {
  using Child = typename Node::ChildNodeType;
  for (auto tile = node.cbeginValueOn(); tile; ++tile) {
    to.activeVoxels += Child::NUM_VOXELS;
    to.box.expand(tile.getCoord(), Child::DIM);
  }
}

/// Adds an internal node without its children.
template <class Node>
void addNode(const Node& node, TreeStatistics& to) {
  addTiles(node, to);
  to.bytes += Node::NUM_VALUES * sizeof(typename Node::UnionType) + 2 * Node::NUM_VALUES / 8 +
              sizeof(openvdb::Coord);
}

/// All three in one walk on all threads. OpenVDB walks three times, once on one thread.
template <class TreeT>
TreeStatistics statisticsOf(const TreeT& tree) {
  using Upper = typename TreeT::RootNodeType::ChildNodeType;
  using Lower = typename Upper::ChildNodeType;
  TreeStatistics all;
  all.bytes = sizeof(tree) + sizeof(tree.root());
  addTiles(tree.root(), all);
  for (auto upper = tree.root().cbeginChildOn(); upper; ++upper) addNode(*upper, all);
  std::vector<const Lower*> nodes;
  tree.getNodes(nodes);
  std::mutex mutex;
  parallelForRanges(nodes.size(), 8, [&](std::size_t begin, std::size_t end) {
    TreeStatistics part;
    for (std::size_t i = begin; i != end; ++i) {
      addNode(*nodes[i], part);
      for (auto leaf = nodes[i]->cbeginChildOn(); leaf; ++leaf) addLeaf(*leaf, part);
    }
    const std::lock_guard lock(mutex);
    all.add(part);
  });
  return all;
}

}  // namespace vox
