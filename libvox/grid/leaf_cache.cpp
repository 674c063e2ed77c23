// Positions and marks become bits of leaves, and these go to the shared ActiveVoxels.

// Highway compiles this file once per instruction set, between HWY_BEFORE_ and HWY_AFTER_NAMESPACE.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "libvox/grid/leaf_cache.cpp"
#include "libvox/grid/leaf_cache.h"

#include "libvox/grid/voxel.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <cstring>

#ifndef VOX_LEAF_CACHE_SHARED
#define VOX_LEAF_CACHE_SHARED
namespace vox {
constexpr std::size_t kMostLanes = 8;
constexpr std::size_t kPlacesAtOnce = LeafCache::kPositionsAtOnce;

/// Places of single voxels: coordinates of the leaf, its slot in the cache, offset in the leaf.
struct LeafCache::VoxelPlaces {
  using Column = std::array<std::int32_t, kPlacesAtOnce>;
  alignas(64) std::array<Column, 3> leaf;
  alignas(64) Column slot;
  alignas(64) Column offset;
};

}  // namespace vox
#endif

HWY_BEFORE_NAMESPACE();
namespace vox::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using D = hn::CappedTag<double, kMostLanes>;

/// Computes the places of the voxels that hold some positions (voxelOf).
/// @param count  of positions, a multiple of kMostLanes
/// @param load   load(i, x, y, z) sets the coordinates of the positions from number i on
template <class Load>
void placeEach(std::size_t count, LeafCache::VoxelPlaces& places, Load&& load) {
  const D d;
  const hn::Rebind<std::int32_t, decltype(d)> d32;
  const auto half = hn::Set(d, 0.5);
  const auto in = hn::Set(d32, 7);
  const auto round = [&](auto x) { return hn::DemoteTo(d32, hn::Floor(hn::Add(x, half))); };
  const auto join = [&](auto x, auto y, auto z) {
    return hn::Or(hn::ShiftLeft<6>(hn::And(x, in)),
                  hn::Or(hn::ShiftLeft<3>(hn::And(y, in)), hn::And(z, in)));
  };
  for (std::size_t i = 0; i < count; i += hn::Lanes(d)) {
    auto xs = hn::Zero(d);
    auto ys = xs;
    auto zs = xs;
    load(i, xs, ys, zs);
    const auto x = round(xs);
    const auto y = round(ys);
    const auto z = round(zs);
    const auto leafX = hn::ShiftRight<MarkBrick::kLeafLog2>(x);
    const auto leafY = hn::ShiftRight<MarkBrick::kLeafLog2>(y);
    const auto leafZ = hn::ShiftRight<MarkBrick::kLeafLog2>(z);
    hn::Store(leafX, d32, places.leaf[0].data() + i);
    hn::Store(leafY, d32, places.leaf[1].data() + i);
    hn::Store(leafZ, d32, places.leaf[2].data() + i);
    hn::Store(join(leafX, leafY, leafZ), d32, places.slot.data() + i);
    hn::Store(join(x, y, z), d32, places.offset.data() + i);
  }
}

void placeInterleaved(const double* HWY_RESTRICT positions, std::size_t count,
                      LeafCache::VoxelPlaces& places) {
  using V = hn::Vec<D>;
  placeEach(count, places, [&](std::size_t i, V& x, V& y, V& z) HWY_ATTR {
    hn::LoadInterleaved3(D(), positions + 3 * i, x, y, z);
  });
}

void placeColumns(const LeafCache::Positions& positions, std::size_t count,
                  LeafCache::VoxelPlaces& places) {
  using V = hn::Vec<D>;
  placeEach(count, places, [&](std::size_t i, V& x, V& y, V& z) HWY_ATTR {
    x = hn::Load(D(), positions.axis[0].data() + i);
    y = hn::Load(D(), positions.axis[1].data() + i);
    z = hn::Load(D(), positions.axis[2].data() + i);
  });
}

}  // namespace vox::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vox {
namespace {

HWY_EXPORT(placeInterleaved);
HWY_EXPORT(placeColumns);

constexpr std::size_t kMostPending = 256;

}  // namespace

LeafCache::LeafCache(ActiveVoxels& grid) : grid_(grid), words_(kSlots), leaves_(kSlots, kNoLeaf) {
  pending_.reserve(kMostPending);
}

void LeafCache::collect(const openvdb::Coord& low, const openvdb::Coord& high) {
  MarkBrick::Taken taken;
  brick_.take(low, high, taken);
  for (std::size_t k = 0; k < taken.count; ++k) send(taken.origins[k], taken.words[k]);
}

void LeafCache::add(std::span<const Vec3d> positions) {
  VoxelPlaces places;
  while (positions.size() >= kMostLanes) {
    const std::size_t count = std::min(positions.size() / kMostLanes * kMostLanes, kPlacesAtOnce);
    HWY_DYNAMIC_DISPATCH(placeInterleaved)(positions[0].data(), count, places);
    addPlaces(places, count);
    positions = positions.subspan(count);
  }
  for (const Vec3d& position : positions) add(voxelOf(position));
}

void LeafCache::add(const Positions& positions, std::size_t count) {
  VoxelPlaces places;
  HWY_DYNAMIC_DISPATCH(placeColumns)
  (positions, (count + kMostLanes - 1) / kMostLanes * kMostLanes, places);
  addPlaces(places, count);
}

void LeafCache::addPlaces(const VoxelPlaces& places, std::size_t count) {
  for (std::size_t i = 0; i < count; ++i) {
    const auto slot = static_cast<std::size_t>(places.slot[i]);
    const auto offset = static_cast<unsigned>(places.offset[i]);
    const auto& [x, y, z] = places.leaf;
    const LeafCoord& known = leaves_[slot];
    if (known.x != x[i] || known.y != y[i] || known.z != z[i]) [[unlikely]]
      replace(slot, {x[i], y[i], z[i]});
    words_[slot][offset >> 6U] |= std::uint64_t{1} << (offset & 63U);
  }
}

void LeafCache::addBlock(const openvdb::Coord& origin, std::uint64_t voxels) {
  const openvdb::Coord leaf = origin >> kLeafLog2;
  const auto in = [](std::int32_t v) { return static_cast<unsigned>(v) & 7U; };
  const unsigned y = in(origin.y());
  const unsigned z = in(origin.z());
  const auto add = [&](std::int32_t x, std::int32_t leafY, std::int32_t leafZ, std::uint64_t bits) {
    if (bits != 0) wordsOf({x >> kLeafLog2, leafY, leafZ})[in(x)] |= bits;
  };
  // A row along z is a byte of a leaf's word; rows beyond the last y go to the next leaf.
  const auto addRows = [&](std::int32_t x, std::int32_t leafZ, std::uint64_t rows) {
    add(x, leaf.y(), leafZ, rows << (8 * y));
    if (y > 4) add(x, leaf.y() + 1, leafZ, rows >> (64 - 8 * y));
  };
  for (std::int32_t i = 0; i < 4; ++i) {
    // Four rows of four bits: each row gets a byte of its own. Then the rows are moved to z; bits
    // beyond the end of this leaf go to the next leaf along z.
    std::uint32_t rows = static_cast<std::uint32_t>(voxels >> (16 * i)) & 0xFFFFU;
    rows = (rows | rows << 8U) & 0x00FF00FFU;
    rows = (rows | rows << 4U) & 0x0F0F0F0FU;
    constexpr std::uint32_t kEachByte = 0x01010101U;
    addRows(origin.x() + i, leaf.z(), (rows & (0xFFU >> z) * kEachByte) << z);
    addRows(origin.x() + i, leaf.z() + 1, rows >> (8 - z) & ((1U << z) - 1) * kEachByte);
  }
}

[[gnu::noinline]] void LeafCache::replace(std::size_t slot, const LeafCoord& leaf) {
  if (leaves_[slot] != kNoLeaf) send(leaves_[slot], words_[slot]);
  words_[slot].fill(0);
  leaves_[slot] = leaf;
}

void LeafCache::send(const LeafCoord& leaf, const LeafWords& words) {
  send(openvdb::Coord(leaf.x << kLeafLog2, leaf.y << kLeafLog2, leaf.z << kLeafLog2), words);
}

void LeafCache::send(const openvdb::Coord& origin, const LeafWords& words) {
  constexpr std::int32_t kPage = 128;
  constexpr std::int32_t kPageMask = ~(kPage - 1);
  const openvdb::Coord pageOrigin(origin.x() & kPageMask, origin.y() & kPageMask,
                                  origin.z() & kPageMask);
  const auto odd = [](std::int32_t v) { return (v & kPage) != 0 ? 1U : 0U; };
  KnownPage& known = pages_[4 * odd(origin.x()) + 2 * odd(origin.y()) + odd(origin.z())];
  if (known.page == nullptr || known.origin != pageOrigin)
    known = {pageOrigin, &grid_.pageOf(origin)};
  pending_.push_back({known.page, origin, words});
  if (pending_.size() == kMostPending) drain();
}

void LeafCache::drain() {
  grid_.add(pending_);
  pending_.clear();
}

void LeafCache::flush() {
  for (std::size_t slot = 0; slot < kSlots; ++slot)
    if (leaves_[slot] != kNoLeaf) send(leaves_[slot], words_[slot]);
  std::fill(leaves_.begin(), leaves_.end(), kNoLeaf);
  drain();
}

}  // namespace vox
#endif
