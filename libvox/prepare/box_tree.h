#pragma once

#include "libvox/core/types.h"

#include <Eigen/Geometry>

#include <cstddef>
#include <vector>

namespace vox {

/// A binary tree of boxes over some items, split at the median: for finding items near a place.
class BoxTree {
 public:
  struct Node {
    Eigen::AlignedBox3d box;  ///< around all its items
    std::size_t begin;        ///< its items: items()[begin, end)
    std::size_t end;
    std::size_t second;  ///< its second child; the first one is the next node. 0: a leaf
  };

  /// @param boxes  of the items 0, 1, 2, ...
  /// Cost O(n log n) for n items.
  explicit BoxTree(const std::vector<Eigen::AlignedBox3d>& boxes);

  const std::vector<Node>& nodes() const { return nodes_; }  ///< parents before children
  const std::vector<Index>& items() const { return items_; }

  /// Calls visit(item) for the items of all leaves that may hold what is looked for.
  /// @param isNear  isNear(node) is false if none of its items is wanted
  template <class IsNear, class Visit>
  void find(IsNear&& isNear, Visit&& visit) const {
    constexpr std::size_t kDeepest = 64;
    std::size_t stack[kDeepest];
    std::size_t depth = 0;
    if (!nodes_.empty()) stack[depth++] = 0;
    while (depth > 0) {
      const std::size_t n = stack[--depth];
      const Node& node = nodes_[n];
      if (!isNear(node)) continue;
      if (node.second == 0) {
        for (std::size_t k = node.begin; k < node.end; ++k) visit(items_[k]);
        continue;
      }
      stack[depth++] = node.second;
      stack[depth++] = n + 1;
    }
  }

 private:
  void build(const std::vector<Eigen::AlignedBox3d>& boxes, std::size_t begin, std::size_t end);

  std::vector<Index> items_;
  std::vector<Node> nodes_;
};

}  // namespace vox
