#pragma once

#include <atomic>
#include <cstdint>
#include <utility>
#include <vector>

namespace vox {

/// Disjoint sets of the numbers 0 .. count - 1. Thread-safe without locks: any number of threads
/// may call find and unite at the same time. A set is named by its lowest element, so the result
/// does not depend on the order of calls. Source: Anderson & Woll 1991, with links from higher to
/// lower elements.
class DisjointSets {
 public:
  explicit DisjointSets(std::size_t count) : parents_(count) {
    for (std::size_t i = 0; i < count; ++i)
      parents_[i].store(static_cast<std::uint32_t>(i), std::memory_order_relaxed);
  }

  /// Lowest element of the set of x. While other threads join sets, it may be outdated.
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

  /// Joins the sets of a and b.
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
