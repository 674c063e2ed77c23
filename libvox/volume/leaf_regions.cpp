// Connected sets of voxels in a leaf, 64 voxels at a time.

#include "libvox/volume/leaf_regions.h"

#include <algorithm>
#include <bit>

namespace vox {
namespace {

constexpr std::uint64_t kLowZ = 0x0101010101010101;
constexpr std::uint64_t kHighZ = kLowZ << 7U;

bool isEmpty(const LeafWords& leaf) {
  return std::all_of(leaf.begin(), leaf.end(), [](std::uint64_t word) { return word == 0; });
}

int lowestVoxel(const LeafWords& leaf) {
  int x = 0;
  while (leaf[static_cast<std::size_t>(x)] == 0) ++x;
  return 64 * x + std::countr_zero(leaf[static_cast<std::size_t>(x)]);
}

/// The voxels of a plane and their neighbours in the plane.
std::uint64_t grownInPlane(std::uint64_t word) {
  return word | word << 8U | word >> 8U | (word & ~kHighZ) << 1U | (word & ~kLowZ) >> 1U;
}

/// The set of voxels within `allowed` that are connected to a voxel through faces.
LeafWords floodedFrom(int voxel, const LeafWords& allowed) {
  LeafWords flooded{};
  flooded[static_cast<std::size_t>(voxel / 64)] = std::uint64_t{1} << (voxel % 64);
  for (bool grows = true; grows;) {
    grows = false;
    for (std::size_t x = 0; x < flooded.size(); ++x) {
      std::uint64_t word = grownInPlane(flooded[x]);
      if (x > 0) word |= flooded[x - 1];
      if (x + 1 < flooded.size()) word |= flooded[x + 1];
      word &= allowed[x];
      grows |= word != flooded[x];
      flooded[x] = word;
    }
  }
  return flooded;
}

LeafWords eroded(const LeafWords& leaf) {
  LeafWords inactive{};
  LeafWords result{};
  for (std::size_t x = 0; x < leaf.size(); ++x) inactive[x] = ~leaf[x];
  for (std::size_t x = 0; x < leaf.size(); ++x) {
    std::uint64_t gone = grownInPlane(inactive[x]);
    if (x > 0) gone |= inactive[x - 1];
    if (x + 1 < leaf.size()) gone |= inactive[x + 1];
    result[x] = ~gone;
  }
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
  LeafWords inactive{};
  for (std::size_t x = 0; x < inactive.size(); ++x) inactive[x] = ~active[x];
  while (!isEmpty(inactive)) {
    regions.push_back(floodedFrom(lowestVoxel(inactive), inactive));
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
