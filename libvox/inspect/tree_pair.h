#pragma once

#include "libvox/grid/openvdb.h"

#include <set>
#include <vector>

namespace vox {

/// A cube of a tree that is as large as a node: the node, or one value if the tree has no node
/// there.
template <class Node>
struct Region {
  using Value = typename Node::ValueType;

  const Node* node = nullptr;
  Value value{};  ///< where there is no node
  bool active = false;
};

template <class Node>
Region<typename Node::ChildNodeType> childOf(const Region<Node>& region, openvdb::Index slot) {
  const Node* const node = region.node;
  if (node == nullptr) return {nullptr, region.value, region.active};
  if (node->isChildMaskOn(slot)) return {node->getTable()[slot].getChild(), {}, false};
  return {nullptr, node->getTable()[slot].getValue(), node->isValueMaskOn(slot)};
}

template <class Leaf>
openvdb::util::NodeMask<3> activeVoxels(const Region<Leaf>& leaf) {
  return leaf.node != nullptr ? leaf.node->getValueMask() : openvdb::util::NodeMask<3>(leaf.active);
}

/// Two trees of one type side by side; their nodes may differ.
///
/// A visitor sees the cubes where one of the trees has something: leaf(origin, a, b) if at least
/// one of the two regions is a leaf; constant(box, a, b) if each of them has one value. Everywhere
/// else both trees are inactive and have the same value, or their backgrounds.
template <class Tree>
class TreePair {
 public:
  using Root = typename Tree::RootNodeType;
  using Upper = typename Root::ChildNodeType;
  using Lower = typename Upper::ChildNodeType;
  using Leaf = typename Tree::LeafNodeType;

  TreePair(const Tree& a, const Tree& b) {
    std::set<openvdb::Coord> keys;
    for (const Tree* tree : {&a, &b})
      for (auto child = tree->root().cbeginChildAll(); child; ++child)
        keys.insert(child.getCoord());
    for (const openvdb::Coord& key : keys)
      split(key, topRegion(a.root(), key), topRegion(b.root(), key));
  }

  /// Number of parts: cubes of up to 128^3 voxels, and tiles. Their order has no meaning.
  std::size_t partCount() const { return parts_.size(); }

  template <class Visitor>
  void visitPart(std::size_t i, Visitor& visitor) const {
    const Part& part = parts_[i];
    if (part.a.node != nullptr || part.b.node != nullptr)
      visitSlots(part, visitor);
    else
      visitor.constant(openvdb::CoordBBox::createCube(part.origin, part.dim), part.a, part.b);
  }

 private:
  struct Part {
    openvdb::Coord origin;
    openvdb::Int32 dim;
    Region<Lower> a, b;
  };

  static Region<Upper> topRegion(const Root& root, const openvdb::Coord& key) {
    return {root.template probeConstNode<Upper>(key), root.getValue(key), root.isValueOn(key)};
  }

  void split(const openvdb::Coord& key, const Region<Upper>& a, const Region<Upper>& b) {
    if (a.node == nullptr && b.node == nullptr) {
      parts_.push_back(
          {key, Upper::DIM, {nullptr, a.value, a.active}, {nullptr, b.value, b.active}});
      return;
    }
    for (openvdb::Index slot = 0; slot < Upper::NUM_VALUES; ++slot) {
      const Part part{key + originOfSlot<Upper>(slot), Lower::DIM, childOf(a, slot),
                      childOf(b, slot)};
      if (!bothEmpty(part.a, part.b)) parts_.push_back(part);
    }
  }

  template <class Node>
  static openvdb::Coord originOfSlot(openvdb::Index slot) {
    openvdb::Coord local;
    Node::offsetToLocalCoord(slot, local);
    return local << Node::ChildNodeType::TOTAL;
  }

  template <class Node>
  static bool bothEmpty(const Region<Node>& a, const Region<Node>& b) {
    return a.node == nullptr && b.node == nullptr && !a.active && !b.active && a.value == b.value;
  }

  template <class Visitor>
  static void visitSlots(const Part& part, Visitor& visitor) {
    for (openvdb::Index slot = 0; slot < Lower::NUM_VALUES; ++slot) {
      const openvdb::Coord origin = part.origin + originOfSlot<Lower>(slot);
      const Region<Leaf> a = childOf(part.a, slot);
      const Region<Leaf> b = childOf(part.b, slot);
      if (a.node != nullptr || b.node != nullptr)
        visitor.leaf(origin, a, b);
      else if (!bothEmpty(a, b))
        visitor.constant(openvdb::CoordBBox::createCube(origin, Leaf::DIM), a, b);
    }
  }

  std::vector<Part> parts_;
};

}  // namespace vox
