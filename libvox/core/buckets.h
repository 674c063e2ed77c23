#pragma once

#include "libvox/core/parallel.h"
#include "libvox/core/types.h"

#include <algorithm>
#include <cstddef>
#include <span>
#include <vector>

namespace vox {

/// Items in buckets: the first pass of a radix sort, so that each bucket fits in a cache. Within a
/// bucket, items keep their order.
template <class Item>
class Buckets {
 public:
  /// Calls forEachOf(i, put) for each i in [0, count), twice, from any thread. forEachOf calls
  /// put(bucket, item) for its items, fewer than 2^32 in all, with bucket < `buckets`, the same
  /// both times.
  /// @param grain  numbers i of a task; each task has a count for each bucket
  template <class ForEachOf>
  Buckets(Index count, Index buckets, ForEachOf&& forEachOf, std::size_t grain = 0) {
    const std::size_t perBlock =
        grain > 0 ? grain : std::max<std::size_t>(kLeastPerBlock, std::size_t{16} * buckets);
    const std::size_t blocks = (count + perBlock - 1) / perBlock;
    const auto forEachOfBlock = [&](std::size_t block, auto&& put) {
      const std::size_t end = std::min<std::size_t>(count, (block + 1) * perBlock);
      for (std::size_t i = block * perBlock; i < end; ++i) forEachOf(static_cast<Index>(i), put);
    };
    std::vector<Index> slots(blocks * buckets, 0);  // first counts, then places
    parallelForEach(blocks, 1, [&](std::size_t block) {
      Index* const mine = slots.data() + block * buckets;
      forEachOfBlock(block, [&](Index bucket, const Item&) { ++mine[bucket]; });
    });
    offsets_.assign(1, 0);
    Index place = 0;
    for (Index bucket = 0; bucket < buckets; ++bucket) {
      for (std::size_t block = 0; block < blocks; ++block) {
        const Index size = slots[block * buckets + bucket];
        slots[block * buckets + bucket] = place;
        place += size;
      }
      offsets_.push_back(place);
    }
    items_.resize(place);
    parallelForEach(blocks, 1, [&](std::size_t block) {
      Index* const mine = slots.data() + block * buckets;
      forEachOfBlock(block, [&](Index bucket, const Item& item) { items_[mine[bucket]++] = item; });
    });
  }

  Index size() const { return static_cast<Index>(offsets_.size() - 1); }
  std::span<const Item> operator[](Index bucket) const {
    return std::span(items_).subspan(offsets_[bucket], offsets_[bucket + 1] - offsets_[bucket]);
  }

 private:
  static constexpr std::size_t kLeastPerBlock = 1 << 16;
  std::vector<Index> offsets_;
  std::vector<Item> items_;
};

}  // namespace vox
