// Connected sets of voxels in a leaf, 64 voxels at a time.

#include "libvox/volume/leaf_regions.h"

namespace vox {
namespace {

constexpr std::uint64_t kLowZ = 0x0101010101010101;

bool isEmpty(const LeafWords& leaf) {
  return leaf == LeafWords{};
}

LeafWords eroded(const LeafWords& leaf) {
  const LeafWords lost = neighboursOf(complementOf(leaf));
  LeafWords result;
  for (std::size_t x = 0; x < leaf.size(); ++x) result[x] = leaf[x] & ~lost[x];
  return result;
}

/// Bits 0, 8, .. 56 of a word, moved to bits 0 .. 7.
std::uint64_t gathered(std::uint64_t column) {
  return column * 0x0102040810204080U >> 56U;
}

}  // namespace

std::uint64_t sideOf(const LeafWords& leaf, int side) {
  const bool upper = side % 2 == 1;
  if (side < 2) return leaf[upper ? 7 : 0];
  std::uint64_t bits = 0;
  for (std::size_t x = 0; x < leaf.size(); ++x) {
    const std::uint64_t row = side < 4 ? leaf[x] >> (upper ? 56U : 0U) & 0xFFU
                                       : gathered(leaf[x] >> (upper ? 7U : 0U) & kLowZ);
    bits |= row << 8 * x;
  }
  return bits;
}

void appendInactiveRegions(const LeafWords& active, std::vector<LeafWords>& regions) {
  LeafWords inactive = complementOf(active);
  while (!isEmpty(inactive)) {
    const int voxel = lowestVoxel(inactive);
    LeafWords seed{};
    seed[static_cast<std::size_t>(voxel / 64)] = std::uint64_t{1} << (voxel % 64);
    regions.push_back(flooded(seed, inactive));
    for (std::size_t x = 0; x < inactive.size(); ++x) inactive[x] &= ~regions.back()[x];
  }
}

DeepVoxel deepestOf(const LeafWords& region) {
  LeafWords core = region;
  constexpr int kMostErosions = 16;  // only the whole leaf survives so many
  for (int depth = 0;; ++depth) {
    const LeafWords next = eroded(core);
    if (depth == kMostErosions || isEmpty(next)) return {depth, lowestVoxel(core)};
    core = next;
  }
}

}  // namespace vox
