#pragma once

#include "libvox/core/numbered.h"
#include "libvox/core/types.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace vox {

/// Disjoint sets of the numbers 0 .. count - 1; at first each number is a set of its own. The root
/// of a set is its lowest element. Not thread-safe.
class Forest {
 public:
  explicit Forest(std::size_t count) : parent_(numbered(count)) {}

  /// Root of the set of x. Halves paths on the way.
  Index find(Index x) {
    while (parent_[x] != x) x = parent_[x] = parent_[parent_[x]];
    return x;
  }

  /// Joins the sets of a and b.
  void unite(Index a, Index b) {
    a = find(a);
    b = find(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<Index> parent_;
};

}  // namespace vox
