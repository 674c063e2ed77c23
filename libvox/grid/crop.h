#pragma once

#include "libvox/grid/openvdb.h"
#include "libvox/grid/region.h"

#include <utility>
#include <vector>

namespace vox {

/// Switches off all voxels of a tree outside a region, and gives them the background. Cost
/// O(nodes). Unlike OpenVDB's Tree::clip, it makes no leaves of background along the sides of the
/// box.
template <class TreeT>
void crop(TreeT& tree, const Region& region) {
  using Leaf = typename TreeT::LeafNodeType;
  using Lower = typename TreeT::RootNodeType::ChildNodeType::ChildNodeType;
  using Value = typename TreeT::ValueType;
  if (region.isAll()) return;
  if (region.isEmpty()) return tree.clear();
  const openvdb::CoordBBox& box = region.box();
  const Value background = tree.background();

  const auto removeAll = [&](const std::vector<openvdb::Coord>& origins, openvdb::Index level) {
    for (const openvdb::Coord& origin : origins) tree.addTile(level, origin, background, false);
  };
  std::vector<openvdb::Coord> outside;
  std::vector<const Lower*> lowers;
  std::as_const(tree).getNodes(lowers);
  for (const Lower* lower : lowers)
    if (!box.hasOverlap(lower->getNodeBoundingBox())) outside.push_back(lower->origin());
  removeAll(outside, Lower::LEVEL + 1);

  struct Tile {
    openvdb::CoordBBox box;
    openvdb::Index level;
    Value value;
    bool isActive;
  };
  std::vector<Tile> tiles;  // with a part outside
  auto tile = std::as_const(tree).cbeginValueAll();
  tile.setMaxDepth(decltype(tile)::LEAF_DEPTH - 1);
  for (; tile; ++tile) {
    const openvdb::CoordBBox all = tile.getBoundingBox();
    if ((tile.isValueOn() || *tile != background) && !box.isInside(all))
      tiles.push_back({all, tile.getLevel(), *tile, tile.isValueOn()});
  }
  for (Tile& one : tiles) {
    tree.addTile(one.level, one.box.min(), background, false);
    one.box.intersect(box);
    if (!one.box.empty()) tree.fill(one.box, one.value, one.isActive);
  }

  outside.clear();
  std::vector<Leaf*> leaves;
  tree.getNodes(leaves);
  for (Leaf* leaf : leaves) {
    const openvdb::CoordBBox all = leaf->getNodeBoundingBox();
    if (!box.hasOverlap(all))
      outside.push_back(leaf->origin());
    else if (!box.isInside(all))
      leaf->clip(box, background);
  }
  removeAll(outside, Leaf::LEVEL + 1);
}

}  // namespace vox
