#pragma once

#include <atomic>
#include <cstdint>
#include <utility>
#include <vector>

namespace vox {

/// Disjoint sets of 0 .. count - 1 that any number of threads may join at once, without locks. A
/// set is known by its lowest element, so the outcome does not depend on the order.
/// Source: Anderson & Woll 1991, with links from higher to lower elements.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parents_(count) {
    for (std::size_t i = 0; i < count; ++i)
      parents_[i].store(static_cast<std::uint32_t>(i), std::memory_order_relaxed);
  }

  /// Lowest element of the set of x, once nobody joins any more.
  std::uint32_t find(std::uint32_t x) {
    for (;;) {
      std::uint32_t parent = parents_[x].load(std::memory_order_relaxed);
      if (parent == x) return x;
      const std::uint32_t above = parents_[parent].load(std::memory_order_relaxed);
      if (above != parent)
        parents_[x].compare_exchange_weak(parent, above, std::memory_order_relaxed);
      x = above;
    }
  }

  void unite(std::uint32_t a, std::uint32_t b) {
    for (;;) {
      a = find(a);
      b = find(b);
      if (a == b) return;
      if (a < b) std::swap(a, b);
      std::uint32_t root = a;
      if (parents_[a].compare_exchange_strong(root, b, std::memory_order_relaxed)) return;
    }
  }

 private:
  std::vector<std::atomic<std::uint32_t>> parents_;
};

}  // namespace vox
