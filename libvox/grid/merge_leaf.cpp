// ORs the bits of leaves and counts new ones in the same pass, while both are in the cache.

// Highway compiles this file once per instruction set, between HWY_BEFORE_ and HWY_AFTER_NAMESPACE.
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "libvox/grid/merge_leaf.cpp"
#include "libvox/grid/merge_leaf.h"

#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include <bit>

HWY_BEFORE_NAMESPACE();
namespace vox::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

#if HWY_TARGET == HWY_SCALAR
std::uint32_t merge(std::uint64_t* bits, const LeafWords& more) {
  int fresh = 0;
  for (std::size_t x = 0; x < more.size(); ++x) {
    fresh += std::popcount(more[x] & ~bits[x]);
    bits[x] |= more[x];
  }
  return static_cast<std::uint32_t>(fresh);
}
#else
std::uint32_t merge(std::uint64_t* HWY_RESTRICT bits, const LeafWords& more) {
  const hn::CappedTag<std::uint64_t, 8> d;
  auto fresh = hn::Zero(d);
  for (std::size_t x = 0; x < more.size(); x += hn::Lanes(d)) {
    const auto old = hn::LoadU(d, bits + x);
    const auto added = hn::LoadU(d, more.data() + x);
    fresh = hn::Add(fresh, hn::PopulationCount(hn::AndNot(old, added)));
    hn::StoreU(hn::Or(old, added), d, bits + x);
  }
  return static_cast<std::uint32_t>(hn::GetLane(hn::SumOfLanes(d, fresh)));
}
#endif

}  // namespace vox::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace vox {
namespace {

HWY_EXPORT(merge);

}  // namespace

std::uint32_t mergeLeaf(std::uint64_t* bits, const LeafWords& more) {
  return HWY_DYNAMIC_DISPATCH(merge)(bits, more);
}

}  // namespace vox
#endif
