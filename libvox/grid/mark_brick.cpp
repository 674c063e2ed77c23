// Packs marks, a byte per voxel, into bits.

// Highway compiles this file once per instruction set, between HWY_BEFORE_ and HWY_AFTER_NAMESPACE.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "libvox/grid/mark_brick.cpp"
#include "libvox/grid/mark_brick.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <algorithm>
#include <new>

HWY_BEFORE_NAMESPACE();
namespace vox::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

constexpr std::size_t kLeafMarks = MarkBrick::kLeafMarks;

/// Turns the 512 marks of a leaf into bits and clears them.
/// @return whether any voxel was marked
#if HWY_TARGET == HWY_SCALAR
inline bool packLeaf(std::uint8_t* marks, std::uint64_t* words) {
  std::uint64_t any = 0;
  for (std::size_t word = 0; word < 8; ++word) {
    words[word] = 0;
    for (std::size_t bit = 0; bit < 64; ++bit)
      words[word] |= std::uint64_t{marks[64 * word + bit] != 0} << bit;
    any |= words[word];
  }
  if (any != 0) std::fill_n(marks, kLeafMarks, std::uint8_t{0});
  return any != 0;
}
#else
inline bool packLeaf(std::uint8_t* HWY_RESTRICT marks, std::uint64_t* HWY_RESTRICT words) {
  const hn::CappedTag<std::uint8_t, 64> bytes;
  const hn::Repartition<std::int8_t, decltype(bytes)> signs;
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

void take(std::uint8_t* marks, const openvdb::Coord* origins, std::size_t count,
          MarkBrick::Taken& taken) {
  taken.count = 0;
  for (std::size_t i = 0; i < count; ++i) {
    taken.origins[taken.count] = origins[i];
    if (packLeaf(marks + MarkBrick::firstMark(origins[i]), taken.words[taken.count].data()))
      ++taken.count;
  }
}

}  // namespace vox::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vox {
namespace {

HWY_EXPORT(take);

constexpr std::align_val_t kAlignment{64};

}  // namespace

void MarkBrick::FreeMarks::operator()(std::uint8_t* marks) const {
  ::operator delete[](marks, kAlignment);
}

MarkBrick::MarkBrick() : marks_(static_cast<std::uint8_t*>(::operator new[](kMarks, kAlignment))) {
  std::fill_n(marks_.get(), kMarks, std::uint8_t{0});
}

void MarkBrick::take(const openvdb::Coord& low, const openvdb::Coord& high, Taken& taken) {
  constexpr std::int32_t kLeafSide = 1 << kLeafLog2;
  const openvdb::Coord first = (low >> kLeafLog2) << kLeafLog2;
  std::array<openvdb::Coord, kLeaves> origins;
  std::size_t count = 0;
  for (std::int32_t x = first.x(); x <= high.x(); x += kLeafSide)
    for (std::int32_t y = first.y(); y <= high.y(); y += kLeafSide)
      for (std::int32_t z = first.z(); z <= high.z(); z += kLeafSide)
        origins[count++].reset(x, y, z);
  HWY_DYNAMIC_DISPATCH(take)(marks_.get(), origins.data(), count, taken);
}

}  // namespace vox
#endif
