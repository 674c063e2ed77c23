#include "libvox/core/parallel.h"

#include "libvox/core/buckets.h"
#include "libvox/core/forest.h"

#include <catch2/catch.hpp>

#include <cstdint>
#include <random>
#include <vector>

using namespace vox;

TEST_CASE("buckets hold every item once, in order, for any number of threads", "[core][parallel]") {
  std::mt19937 random(5);
  for (const Index count : {0U, 1U, 1000U, 300'000U})
    for (const Index size : {1U, 7U, 5000U})
      for (const int threads : {1, 4}) {
        CAPTURE(count, size, threads);
        std::vector<std::uint32_t> keys(count);
        for (auto& key : keys) key = static_cast<std::uint32_t>(random());
        // Numbers whose key ends in 0 have no item, those whose key ends in 1 have two.
        const auto forEachOf = [&](Index i, auto&& put) {
          const std::uint32_t last = keys[i] % 4;
          if (last != 0) put(keys[i] / 4 % size, i);
          if (last == 1) put((keys[i] / 4 + 1) % size, i);
        };
        std::vector<std::vector<Index>> expected(size);
        for (Index i = 0; i < count; ++i)
          forEachOf(i, [&](Index bucket, Index item) { expected[bucket].push_back(item); });
        onThreads(threads, [&] {
          const Buckets<Index> buckets(count, size, forEachOf);
          REQUIRE(buckets.size() == size);
          bool same = true;
          for (Index b = 0; b < size; ++b)
            same &= std::vector<Index>(buckets[b].begin(), buckets[b].end()) == expected[b];
          CHECK(same);
          return 0;
        });
      }
}

TEST_CASE("a forest joined by many threads has the sets of the graph, by their lowest elements",
          "[core][parallel]") {
  constexpr Index kCount = 20'000;
  std::mt19937 random(11);
  for (const std::size_t edges : {0UL, 5'000UL, 12'000UL, 60'000UL}) {
    std::vector<std::pair<Index, Index>> pairs;
    for (std::size_t k = 0; k < edges; ++k)
      pairs.emplace_back(random() % kCount, random() % kCount);
    // Labels spread along the edges until nothing changes.
    std::vector<Index> lowest = numbered(kCount);
    for (bool changed = true; changed;) {
      changed = false;
      for (const auto& [a, b] : pairs) {
        const Index low = std::min(lowest[a], lowest[b]);
        changed |= lowest[a] != low || lowest[b] != low;
        lowest[a] = lowest[b] = low;
      }
    }
    Forest forest(kCount);
    onThreads(4, [&] {
      parallelForEach(pairs.size(), 8,
                      [&](std::size_t k) { forest.unite(pairs[k].first, pairs[k].second); });
      return 0;
    });
    bool same = true;
    for (Index x = 0; x < kCount; ++x) same &= forest.find(x) == lowest[x];
    CHECK(same);
  }
}

TEST_CASE("the lowest element is found, and sums do not depend on threads", "[core][parallel]") {
  constexpr Index kCount = 100'000;
  std::vector<double> values(kCount);
  std::mt19937 random(3);
  for (double& value : values) value = std::ldexp(1.0, static_cast<int>(random() % 100));
  const auto sumOf = [&](std::size_t begin, std::size_t end) {
    double sum = 0;
    for (std::size_t i = begin; i < end; ++i) sum += values[i];
    return sum;
  };
  const double expected = onThreads(1, [&] { return parallelSum(kCount, 64, 0.0, sumOf); });
  for (int repeat = 0; repeat < 20; ++repeat)
    onThreads(4, [&] {
      CHECK(parallelSum(kCount, 64, 0.0, sumOf) == expected);
      for (const Index first : {0U, 1U, 77'777U, kCount - 1, kCount})
        CHECK(lowestWhere(kCount, 16, [&](Index i) { return i >= first && i % 3 == first % 3; }) ==
              std::min(first, kCount));
      return 0;
    });
}
