#pragma once

#include "libvox/core/numbered.h"
#include "libvox/core/parallel.h"
#include "libvox/core/types.h"

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <utility>
#include <vector>

namespace vox {

/// Disjoint sets of the numbers 0 .. count - 1; at first each number is a set of its own. The root
/// of a set is its lowest element. Any threads may call any functions at the same time; the sets
/// in the end do not depend on the order of the calls. (R. J. Anderson, H. Woll, Wait-free parallel
/// algorithms for the union-find problem, 1991.)
class Forest {
 public:
  explicit Forest(std::size_t count) : parent_(numbered(count)) {}

  /// Root of the set of x. Halves paths on the way.
  Index find(Index x) {
    for (Index up = parent(x).load(kRelaxed); up != x;) {
      const Index above = parent(up).load(kRelaxed);
      if (above == up) return up;
      parent(x).store(above, kRelaxed);  // an ancestor stays an ancestor
      x = above;
      up = parent(x).load(kRelaxed);
    }
    return x;
  }

  /// Root of the set of each number. Parallel; uses up the forest.
  std::vector<Index> takeRoots() {
    parallelForEach(static_cast<Index>(parent_.size()), kElementsPerTask, [&](Index x) {
      Index root = x;  // not by find: while others write roots, it could put back an ancestor
      for (Index up = parent(x).load(kRelaxed); up != root; up = parent(up).load(kRelaxed))
        root = up;
      parent(x).store(root, kRelaxed);
    });
    return std::move(parent_);
  }

  /// Joins the sets of a and b.
  void unite(Index a, Index b) {
    for (;;) {
      a = find(a);
      b = find(b);
      if (a == b) return;
      if (a < b) std::swap(a, b);
      Index itself = a;  // only roots are linked, and only to lower ones
      if (parent(a).compare_exchange_weak(itself, b, kRelaxed)) return;
    }
  }

 private:
  static constexpr std::memory_order kRelaxed = std::memory_order_relaxed;
  std::atomic_ref<Index> parent(Index x) { return std::atomic_ref<Index>(parent_[x]); }

  std::vector<Index> parent_;
};

}  // namespace vox
