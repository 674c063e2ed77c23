#pragma once

#include "libvox/core/parallel.h"
#include "libvox/grid/openvdb.h"
#include "libvox/grid/region.h"

#include <utility>
#include <vector>

namespace vox {

/// Switches off all voxels of a tree outside a box, and gives them the background. Cost O(nodes).
/// Unlike OpenVDB's Tree::clip, it makes no leaves of background along the sides of the box.
template <class TreeT>
void cropToBox(TreeT& tree, const openvdb::CoordBBox& box) {
  if (box.empty()) return tree.clear();
  using Leaf = typename TreeT::LeafNodeType;
  using Lower = typename TreeT::RootNodeType::ChildNodeType::ChildNodeType;
  using Value = typename TreeT::ValueType;
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

/// Whether a node has no child and no active tile, and all its tiles have the background.
template <class Node>
bool isBackground(const Node& node, const typename Node::ValueType& background) {
  if (!node.isChildMaskOff() || !node.isValueMaskOff()) return false;
  for (openvdb::Index i = 0; i < Node::NUM_VALUES; ++i)
    if (node.getTable()[i].getValue() != background) return false;
  return true;
}

/// Gives all leaves and pages outside the pages of a region the background.
template <class TreeT>
void cropToPages(TreeT& tree, const Region& region) {
  using Leaf = typename TreeT::LeafNodeType;
  using Upper = typename TreeT::RootNodeType::ChildNodeType;
  using Lower = typename Upper::ChildNodeType;
  const typename TreeT::ValueType background = tree.background();

  // Tiles of the root become tiles of pages.
  std::vector<openvdb::Coord> large;
  for (auto tile = std::as_const(tree).root().cbeginValueAll(); tile; ++tile)
    large.push_back(tile.getCoord());
  for (const openvdb::Coord& origin : large)
    tree.root().addChild(new Upper(origin, tree.getValue(origin), tree.isValueOn(origin)));

  std::vector<Upper*> uppers;
  tree.getNodes(uppers);
  parallelForEach(uppers.size(), 1, [&](std::size_t u) {
    Upper& upper = *uppers[u];
    for (openvdb::Index i = 0; i < Upper::NUM_VALUES; ++i) {
      const bool isTile = !upper.isChildMaskOn(i);
      if (isTile && !upper.isValueMaskOn(i) && upper.getTable()[i].getValue() == background)
        continue;
      const openvdb::CoordBBox page =
          openvdb::CoordBBox::createCube(upper.offsetToGlobalCoord(i), Lower::DIM);
      if (!region.meetsPages(page)) {
        upper.addTile(Lower::LEVEL + 1, page.min(), background, false);
        continue;
      }
      if (isTile) continue;
      Lower& lower = *upper.getTable()[i].getChild();
      for (openvdb::Index j = 0; j < Lower::NUM_VALUES; ++j)
        if (lower.isChildMaskOn(j) &&
            !region.meetsPages(lower.getTable()[j].getChild()->getNodeBoundingBox()))
          lower.addTile(Leaf::LEVEL + 1, lower.offsetToGlobalCoord(j), background, false);
    }
  });
  for (const Upper* upper : uppers)
    if (isBackground(*upper, background))
      tree.addTile(Upper::LEVEL + 1, upper->origin(), background, false);
  tree.root().eraseBackgroundTiles();
}

/// Switches off all voxels of a tree outside a region, and gives them the background. At the margin
/// of pages whole leaves stay.
template <class TreeT>
void crop(TreeT& tree, const Region& region) {
  if (region.box()) cropToBox(tree, *region.box());
  if (region.hasPages()) cropToPages(tree, region);
}

}  // namespace vox
