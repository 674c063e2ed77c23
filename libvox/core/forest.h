#pragma once

#include "libvox/core/numbered.h"
#include "libvox/core/types.h"

#include <algorithm>
#include <cstddef>
#include <vector>

namespace vox {

/// Disjoint sets of 0 .. count - 1; the root of a set is its lowest element.
class Forest {
 public:
  explicit Forest(std::size_t count) : parent_(numbered(count)) {}

  Index find(Index x) {
    while (parent_[x] != x) x = parent_[x] = parent_[parent_[x]];
    return x;
  }

  void unite(Index a, Index b) {
    a = find(a);
    b = find(b);
    parent_[std::max(a, b)] = std::min(a, b);
  }

 private:
  std::vector<Index> parent_;
};

}  // namespace vox
