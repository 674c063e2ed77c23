// Union-find over the tree of a surface. Its elements are connected sets of inactive voxels in
// leaves, and places of nodes without a leaf or an inner node. Elements that touch with their faces
// are joined; what is not joined to the outside is enclosed.

#include "libvox/volume/fill.h"

#include "libvox/core/error.h"
#include "libvox/core/parallel.h"
#include "libvox/grid/leaf_words.h"
#include "libvox/grid/openvdb.h"
#include "libvox/volume/disjoint_sets.h"
#include "libvox/volume/leaf_regions.h"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <map>
#include <memory>
#include <tuple>
#include <utility>

namespace vox {
namespace {

using openvdb::Coord;
using openvdb::MaskTree;
using Leaf = MaskTree::LeafNodeType;
using Upper = MaskTree::RootNodeType::ChildNodeType;
using Lower = Upper::ChildNodeType;
using Element = std::uint32_t;

constexpr Element kOutside = 0;
constexpr Element kActive = std::numeric_limits<Element>::max();
constexpr std::size_t kLeavesPerTask = 64;

/// Vector of a length perpendicular to a side of a cube (kSides), pointing outward.
Coord stepAcross(int side, int length) {
  Coord step(0, 0, 0);
  step[side / 2] = side % 2 == 1 ? length : -length;
  return step;
}

/// Order by rows along x. Neighbours in this order, in one row, have no other element between them.
struct ByRow {
  bool operator()(const Coord& a, const Coord& b) const {
    return std::make_tuple(a.z(), a.y(), a.x()) < std::make_tuple(b.z(), b.y(), b.x());
  }
};

/// Whether a place in a node has neither a child nor an active tile.
template <class Node>
bool isInactive(const Node& node, openvdb::Index slot) {
  return !node.isChildMaskOn(slot) && !node.isValueMaskOn(slot);
}

class Flood {
 public:
  explicit Flood(const MaskTree& surface) {
    surface.getNodes(uppers_);
    surface.getNodes(lowers_);
    findLeaves();
    findRegions();
    numberElements();
  }

  /// Joins all elements that touch.
  void run() {
    sets_ = std::make_unique<DisjointSets>(elementCount_);
    parallelForEach(lowers_.size(), 1, [&](std::size_t l) { joinInLower(l); });
    parallelForEach(uppers_.size(), 1, [&](std::size_t u) { joinInUpper(u); });
    joinAroundUppers();
  }

  /// Joins the regions that are cavities to the outside.
  void open(const AreCavities& areCavities) {
    std::map<Element, std::pair<int, Coord>> deepest;  // depth and voxel, by enclosed region
    forEachEnclosed([&](Element e, int depth, const Coord& voxel) {
      const auto [region, isNew] = deepest.try_emplace(sets_->find(e), depth, voxel);
      if (!isNew && depth > region->second.first) region->second = {depth, voxel};
    });
    if (deepest.empty()) return;
    std::vector<Coord> voxels;
    for (const auto& [region, deep] : deepest) voxels.push_back(deep.second);
    const std::vector<bool> cavity = areCavities(voxels);
    std::size_t i = 0;
    for (const auto& [region, deep] : deepest)
      if (cavity[i++]) sets_->unite(region, kOutside);
  }

  /// Switches on everything that is enclosed, in a copy of the surface.
  void fill(MaskTree& copy) {
    std::vector<Upper*> uppers;
    std::vector<Lower*> lowers;
    copy.getNodes(uppers);
    copy.getNodes(lowers);
    parallelForEach(lowers.size(), 1, [&](std::size_t l) { fillLower(l, *lowers[l]); });
    parallelForEach(uppers.size(), 1, [&](std::size_t u) {
      for (openvdb::Index slot = 0; slot < Upper::NUM_VALUES; ++slot)
        if (!uppers[u]->isChildMaskOn(slot) && isEnclosed(upperElement(u, slot)))
          uppers[u]->addTile(slot, true, true);
    });
    fillAroundUppers(copy);
  }

 private:
  // Elements, in the order of their numbers: the outside; inactive regions of leaves; all places in
  // lower nodes and then in upper nodes, empty or not; empty neighbours of upper nodes (the shell).
  Element leafElement(Element region) const { return 1 + region; }
  Element lowerElement(std::size_t l, openvdb::Index slot) const {
    return static_cast<Element>(firstOfLowers_ + l * Lower::NUM_VALUES + slot);
  }
  Element upperElement(std::size_t u, openvdb::Index slot) const {
    return static_cast<Element>(firstOfUppers_ + u * Upper::NUM_VALUES + slot);
  }
  /// Whether an inactive element is enclosed. Valid after run().
  bool isEnclosed(Element e) { return sets_->find(e) != kOutside; }

  void findLeaves() {
    for (std::size_t l = 0; l < lowers_.size(); ++l) {
      lowerAt_[lowers_[l]->origin()] = l;
      firstLeaf_.push_back(static_cast<Element>(leaves_.size()));
      for (auto leaf = lowers_[l]->cbeginChildOn(); leaf; ++leaf) leaves_.push_back(&*leaf);
    }
    for (std::size_t u = 0; u < uppers_.size(); ++u) upperAt_[uppers_[u]->origin()] = u;
  }

  void findRegions() {
    std::vector<std::vector<LeafWords>> ofTask(leaves_.size() / kLeavesPerTask + 1);
    firstRegion_.assign(leaves_.size() + 1, 0);
    parallelForEach(ofTask.size(), 1, [&](std::size_t task) {
      const std::size_t end = std::min(leaves_.size(), (task + 1) * kLeavesPerTask);
      for (std::size_t i = task * kLeavesPerTask; i < end; ++i) {
        const std::size_t before = ofTask[task].size();
        appendInactiveRegions(activeWords(*leaves_[i]), ofTask[task]);
        firstRegion_[i + 1] = static_cast<Element>(ofTask[task].size() - before);
      }
    });
    for (std::size_t i = 0; i < leaves_.size(); ++i) firstRegion_[i + 1] += firstRegion_[i];
    for (const auto& regions : ofTask)
      regions_.insert(regions_.end(), regions.begin(), regions.end());
  }

  void numberElements() {
    findShell();
    firstOfLowers_ = 1 + regions_.size();
    firstOfUppers_ = firstOfLowers_ + lowers_.size() * Lower::NUM_VALUES;
    firstOfShell_ = firstOfUppers_ + uppers_.size() * Upper::NUM_VALUES;
    elementCount_ = firstOfShell_ + shell_.size();
    if (elementCount_ >= kActive)
      throw LimitError("the surface has too many leaves to fill; use larger voxels");
  }

  /// Finds the empty places of upper nodes around the existing ones.
  void findShell() {
    for (const auto& [origin, u] : upperAt_)
      for (int i = -1; i <= 1; ++i)
        for (int j = -1; j <= 1; ++j)
          for (int k = -1; k <= 1; ++k) {
            const int dim = static_cast<int>(Upper::DIM);
            const Coord near = origin.offsetBy(i * dim, j * dim, k * dim);
            if (upperAt_.count(near) == 0) shell_.emplace(near, 0);
          }
    Element number = 0;
    for (auto& [origin, element] : shell_) element = number++;
  }
  Element shellElement(const Coord& origin) const {
    return static_cast<Element>(firstOfShell_ + shell_.at(origin));
  }

  /// The element that holds a voxel outside all lower nodes; kActive if that is an active tile.
  Element elementAround(const Coord& voxel) const {
    const Coord origin = voxel & ~(static_cast<int>(Upper::DIM) - 1);
    const auto upper = upperAt_.find(origin);
    if (upper == upperAt_.end()) return shellElement(origin);
    const openvdb::Index slot = Upper::coordToOffset(voxel);
    if (uppers_[upper->second]->isValueMaskOn(slot)) return kActive;
    return upperElement(upper->second, slot);
  }

  /// Calls visit(element, bits) for the elements at a place of a lower node that reach a side of
  /// the place; the bits are their voxels on this side (sideOf).
  template <class Visit>
  void forSide(std::size_t l, openvdb::Index slot, int side, Visit&& visit) const {
    if (lowers_[l]->isValueMaskOn(slot)) return;  // active
    if (!lowers_[l]->isChildMaskOn(slot)) return visit(lowerElement(l, slot), ~std::uint64_t{0});
    const Element leaf = leafAt(l, slot);
    for (Element r = firstRegion_[leaf]; r < firstRegion_[leaf + 1]; ++r)
      if (const std::uint64_t bits = sideOf(regions_[r], side)) visit(leafElement(r), bits);
  }
  Element leafAt(std::size_t l, openvdb::Index slot) const {
    // Children are in the order of their places.
    Element rank = firstLeaf_[l];
    const auto& mask = lowers_[l]->getChildMask();
    for (openvdb::Index word = 0; word < slot / 64; ++word)
      rank += openvdb::util::CountOn(mask.getWord<openvdb::Index64>(word));
    const openvdb::Index64 below = (openvdb::Index64{1} << (slot % 64)) - 1;
    return rank + openvdb::util::CountOn(mask.getWord<openvdb::Index64>(slot / 64) & below);
  }

  void joinPlaces(std::size_t l, openvdb::Index slot, std::size_t m, openvdb::Index other,
                  int axis) {
    forSide(l, slot, 2 * axis + 1, [&](Element a, std::uint64_t bitsA) {
      forSide(m, other, 2 * axis, [&](Element b, std::uint64_t bitsB) {
        if ((bitsA & bitsB) != 0) sets_->unite(a, b);
      });
    });
  }

  /// Whether two places in a lower node, neighbours across a row along z, are inactive and so are
  /// those before them in their rows: then these are joined, and the rows are.
  static bool areJoinedBefore(const Lower& lower, openvdb::Index slot, openvdb::Index next,
                              const Coord& local) {
    return next != slot + 1 && local.z() > 0 && isInactive(lower, slot) &&
           isInactive(lower, next) && isInactive(lower, slot - 1) && isInactive(lower, next - 1);
  }

  /// Joins the elements of each place of a lower node with those of the next place along each axis.
  /// At the border of the node, the next place may be in another node.
  void joinInLower(std::size_t l) {
    constexpr int kSide = 1 << Lower::LOG2DIM;
    constexpr int kLeafDim = Leaf::DIM;
    for (openvdb::Index slot = 0; slot < Lower::NUM_VALUES; ++slot) {
      Coord local;
      Lower::offsetToLocalCoord(slot, local);
      const Coord origin = lowers_[l]->offsetToGlobalCoord(slot);
      for (int side = 0; side < kSides; ++side) {
        const int axis = side / 2;
        const bool upper = side % 2 == 1;
        if (local[axis] != (upper ? kSide - 1 : 0)) {
          const openvdb::Index next = slot + (openvdb::Index{1} << (2 - axis) * Lower::LOG2DIM);
          if (upper && !areJoinedBefore(*lowers_[l], slot, next, local))
            joinPlaces(l, slot, l, next, axis);
          continue;
        }
        const Coord across = origin + stepAcross(side, kLeafDim);
        const auto next = lowerAt_.find(across & ~(static_cast<int>(Lower::DIM) - 1));
        if (next == lowerAt_.end()) {
          const Element around = elementAround(across);
          if (around == kActive) continue;
          forSide(l, slot, side, [&](Element e, std::uint64_t) { sets_->unite(e, around); });
        } else if (upper) {
          joinPlaces(l, slot, next->second, Lower::coordToOffset(across), axis);
        }
      }
    }
  }

  /// Joins the empty places of an upper node with their neighbours, except lower nodes: these are
  /// joined in joinInLower.
  void joinInUpper(std::size_t u) {
    constexpr int kSide = 1 << Upper::LOG2DIM;
    const Upper& upper = *uppers_[u];
    for (openvdb::Index slot = 0; slot < Upper::NUM_VALUES; ++slot) {
      if (!isInactive(upper, slot)) continue;
      Coord local;
      Upper::offsetToLocalCoord(slot, local);
      for (int side = 0; side < kSides; ++side) {
        const int axis = side / 2;
        const bool isUp = side % 2 == 1;
        if (local[axis] != (isUp ? kSide - 1 : 0)) {
          // The lower one of two places in this node joins them.
          const openvdb::Index next = slot + (openvdb::Index{1} << (2 - axis) * Upper::LOG2DIM);
          if (isUp && isInactive(upper, next))
            sets_->unite(upperElement(u, slot), upperElement(u, next));
          continue;
        }
        const Coord across =
            upper.offsetToGlobalCoord(slot) + stepAcross(side, static_cast<int>(Lower::DIM));
        if (lowerAt_.count(across) > 0) continue;
        const Element around = elementAround(across);
        if (around != kActive) sets_->unite(upperElement(u, slot), around);
      }
    }
  }

  /// Joins the elements of the shell: with their neighbours along y and z; with the previous one in
  /// the row, if there is no upper node between them; and the first one of a row with the outside.
  /// That joins all that are connected. For a connected set of upper nodes, the empty places around
  /// it are connected with each other; and from the leftmost of them the row leads to the places
  /// around this set.
  void joinAroundUppers() {
    constexpr int kDim = static_cast<int>(Upper::DIM);
    for (auto place = shell_.begin(); place != shell_.end(); ++place) {
      const Coord& origin = place->first;
      for (const Coord& next : {origin.offsetBy(0, kDim, 0), origin.offsetBy(0, 0, kDim)})
        if (shell_.count(next) > 0) sets_->unite(shellElement(origin), shellElement(next));
      const auto before = place == shell_.begin() ? place : std::prev(place);
      if (before == place || before->first.y() != origin.y() || before->first.z() != origin.z())
        sets_->unite(shellElement(origin), kOutside);
      else if (upperAt_.count(origin.offsetBy(-kDim, 0, 0)) == 0)
        sets_->unite(shellElement(origin), shellElement(before->first));
    }
  }

  void fillLower(std::size_t l, Lower& lower) {
    Element leaf = firstLeaf_[l];
    for (openvdb::Index slot = 0; slot < Lower::NUM_VALUES; ++slot) {
      if (!lower.isChildMaskOn(slot)) {
        if (isEnclosed(lowerElement(l, slot))) lower.addTile(slot, true, true);
        continue;
      }
      auto child = lower.probeLeaf(lower.offsetToGlobalCoord(slot));
      for (Element r = firstRegion_[leaf]; r < firstRegion_[leaf + 1]; ++r)
        if (isEnclosed(leafElement(r)))
          for (std::size_t x = 0; x < regions_[r].size(); ++x)
            child->buffer().data()[x] |= regions_[r][x];
      ++leaf;
    }
  }

  void fillAroundUppers(MaskTree& copy) {
    constexpr int kDim = static_cast<int>(Upper::DIM);
    for (auto place = shell_.begin(); place != shell_.end(); ++place) {
      if (!isEnclosed(shellElement(place->first))) continue;
      // The element stands for all empty places up to the next known place in the row.
      Coord at = place->first;
      do {
        copy.root().addTile(at, true, true);
        at.x() += kDim;
      } while (shell_.count(at) == 0 && upperAt_.count(at) == 0);
    }
  }

  /// Calls visit(element, depth, voxel) for each enclosed element, with its deepest voxel.
  template <class Visit>
  void forEachEnclosed(Visit&& visit) {
    const auto visitTile = [&](Element e, const Coord& origin, int dim) {
      if (isEnclosed(e)) visit(e, dim / 2, origin.offsetBy(dim / 2));
    };
    for (const auto& [origin, number] : shell_)
      visitTile(shellElement(origin), origin, static_cast<int>(Upper::DIM));
    for (std::size_t u = 0; u < uppers_.size(); ++u)
      for (openvdb::Index slot = 0; slot < Upper::NUM_VALUES; ++slot)
        if (isInactive(*uppers_[u], slot))
          visitTile(upperElement(u, slot), uppers_[u]->offsetToGlobalCoord(slot),
                    static_cast<int>(Lower::DIM));
    for (std::size_t l = 0; l < lowers_.size(); ++l)
      for (openvdb::Index slot = 0; slot < Lower::NUM_VALUES; ++slot)
        if (isInactive(*lowers_[l], slot))
          visitTile(lowerElement(l, slot), lowers_[l]->offsetToGlobalCoord(slot), Leaf::DIM);
    for (Element leaf = 0; leaf < leaves_.size(); ++leaf)
      for (Element r = firstRegion_[leaf]; r < firstRegion_[leaf + 1]; ++r) {
        if (!isEnclosed(leafElement(r))) continue;
        const DeepVoxel deep = deepestOf(regions_[r]);
        visit(leafElement(r), deep.depth,
              leaves_[leaf]->origin() +
                  Leaf::offsetToLocalCoord(static_cast<openvdb::Index>(deep.voxel)));
      }
  }

  std::vector<const Upper*> uppers_;
  std::vector<const Lower*> lowers_;
  std::vector<const Leaf*> leaves_;       // lower node after lower node
  std::map<Coord, std::size_t> upperAt_;  // by origin
  std::map<Coord, std::size_t> lowerAt_;
  std::map<Coord, Element, ByRow> shell_;  // empty neighbours of upper nodes
  std::vector<Element> firstLeaf_;         // per lower node: index of its first leaf
  std::vector<Element> firstRegion_;       // per leaf, + 1: index of its first region
  std::vector<LeafWords> regions_;
  std::size_t firstOfLowers_ = 0;
  std::size_t firstOfUppers_ = 0;
  std::size_t firstOfShell_ = 0;
  std::size_t elementCount_ = 0;
  std::unique_ptr<DisjointSets> sets_;
};

}  // namespace

openvdb::MaskTree::Ptr filled(const openvdb::MaskTree& surface, const AreCavities& areCavities) {
  Flood flood(surface);
  flood.run();
  if (areCavities) flood.open(areCavities);
  auto solid = std::make_shared<MaskTree>(surface);
  flood.fill(*solid);
  return solid;
}

std::uint64_t bytesOfFilling(const openvdb::MaskTree& surface) {
  const auto nodes = surface.nodeCount();  // leaves first, root last
  constexpr std::uint64_t kRegions = 2;    // most leaves have no more
  return nodes[0] * (sizeof(Leaf) + 2 * kRegions * sizeof(LeafWords)) +
         nodes[1] * (sizeof(Lower) + Lower::NUM_VALUES * sizeof(Element)) +
         nodes[2] * (sizeof(Upper) + Upper::NUM_VALUES * sizeof(Element));
}

}  // namespace vox
