// Bytes to bits, and bits to the shared grid.

// Highway compiles this file once per instruction set, between HWY_BEFORE_ and HWY_AFTER_NAMESPACE.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "libvox/grid/leaf_cache.cpp"
#include "libvox/grid/leaf_cache.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <cstring>

HWY_BEFORE_NAMESPACE();
namespace vox::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Turns the 512 marks of a leaf into bits and clears them.
/// @return whether there were any
#if HWY_TARGET == HWY_SCALAR
bool packLeaf(std::uint8_t* marks, std::uint64_t* words) {
  std::uint64_t any = 0;
  for (std::size_t word = 0; word < 8; ++word) {
    words[word] = 0;
    for (std::size_t bit = 0; bit < 64; ++bit)
      words[word] |= std::uint64_t{marks[64 * word + bit] != 0} << bit;
    any |= words[word];
  }
  if (any != 0) std::fill_n(marks, 512, std::uint8_t{0});
  return any != 0;
}
#else
bool packLeaf(std::uint8_t* HWY_RESTRICT marks, std::uint64_t* HWY_RESTRICT words) {
  const hn::CappedTag<std::uint8_t, 64> bytes;
  const hn::Repartition<std::int8_t, decltype(bytes)> signs;
  constexpr std::size_t kLeafMarks = 512;
  const std::size_t lanes = hn::Lanes(bytes);
  auto any = hn::Zero(bytes);
  for (std::size_t i = 0; i < kLeafMarks; i += lanes) any = hn::Or(any, hn::Load(bytes, marks + i));
  if (hn::AllFalse(bytes, hn::Ne(any, hn::Zero(bytes)))) return false;
  auto* bits = reinterpret_cast<std::uint8_t*>(words);
  for (std::size_t i = 0; i < kLeafMarks; i += lanes) {
    const auto marked = hn::Lt(hn::BitCast(signs, hn::Load(bytes, marks + i)), hn::Zero(signs));
    hn::StoreMaskBits(signs, marked, bits + i / 8);
    hn::Store(hn::Zero(bytes), bytes, marks + i);
  }
  return true;
}
#endif

}  // namespace vox::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vox {
namespace {

HWY_EXPORT(packLeaf);

constexpr std::size_t kLeafMarks = 512;
constexpr std::align_val_t kAlignment{64};

}  // namespace

void LeafCache::FreeMarks::operator()(std::uint8_t* marks) const {
  ::operator delete[](marks, kAlignment);
}

LeafCache::LeafCache(SurfaceGrid& grid)
    : grid_(grid), marks_(static_cast<std::uint8_t*>(::operator new[](kMarks, kAlignment))) {
  std::fill_n(marks_.get(), kMarks, std::uint8_t{0});
  // Each slot starts with a leaf that belongs there, so that no slot is special.
  for (std::size_t slot = 0; slot < leaves_.size(); ++slot)
    leaves_[slot] = {static_cast<std::int32_t>(slot >> 4U),
                     static_cast<std::int32_t>(slot >> 2U & 3U),
                     static_cast<std::int32_t>(slot & 3U), 0};
}

void LeafCache::claimLeaf(std::int32_t x, std::int32_t y, std::int32_t z) {
  constexpr std::int32_t kMask = kSide - 1;
  const auto slot = static_cast<std::size_t>((x & kMask) << 4 | (y & kMask) << 2 | (z & kMask));
  const LeafCoord leaf = {x, y, z, 0};
  if (leaves_[slot] == leaf) return;
  send(slot);
  leaves_[slot] = leaf;
}

void LeafCache::claim(const openvdb::Coord& low, const openvdb::Coord& high) {
  const openvdb::Coord first = low >> kLeafLog2;
  const openvdb::Coord last = high >> kLeafLog2;
  for (std::int32_t x = first.x(); x <= last.x(); ++x)
    for (std::int32_t y = first.y(); y <= last.y(); ++y)
      for (std::int32_t z = first.z(); z <= last.z(); ++z) claimLeaf(x, y, z);
}

void LeafCache::mark(const openvdb::Coord& voxel) {
  claim(voxel, voxel);
  const auto bits = [](std::int32_t v, int low, int count, int to) {
    return static_cast<std::size_t>(v >> low & ((1 << count) - 1)) << to;
  };
  const std::size_t inLeaf =
      bits(voxel.z(), 0, 3, 0) | bits(voxel.y(), 0, 3, 3) | bits(voxel.x(), 0, 3, 6);
  const std::size_t ofLeaf =
      bits(voxel.z(), 3, 2, 9) | bits(voxel.y(), 3, 2, 11) | bits(voxel.x(), 3, 2, 13);
  marks_[inLeaf | ofLeaf] = kMarked;
}

void LeafCache::send(std::size_t slot) {
  alignas(64) LeafWords words;
  if (!HWY_DYNAMIC_DISPATCH(packLeaf)(marks_.get() + slot * kLeafMarks, words.data())) return;
  const LeafCoord& leaf = leaves_[slot];
  const openvdb::Coord origin(leaf[0] << kLeafLog2, leaf[1] << kLeafLog2, leaf[2] << kLeafLog2);
  constexpr std::int32_t kPageMask = ~127;
  const openvdb::Coord pageOrigin(origin.x() & kPageMask, origin.y() & kPageMask,
                                  origin.z() & kPageMask);
  if (page_ == nullptr || pageOrigin != pageOrigin_) {
    page_ = &grid_.pageOf(origin);
    pageOrigin_ = pageOrigin;
  }
  grid_.add(*page_, origin, words);
}

void LeafCache::flush() {
  for (std::size_t slot = 0; slot < leaves_.size(); ++slot) send(slot);
}

}  // namespace vox
#endif
