// Sets of voxels of a leaf, many voxels at a time.

#include "libvox/grid/leaf_words.h"

#include <bit>
#include <cstddef>

namespace vox {
namespace {

constexpr std::uint64_t kNotFirstZ = 0xFEFEFEFEFEFEFEFE;
constexpr std::uint64_t kNotLastZ = 0x7F7F7F7F7F7F7F7F;

/// Spreads `f` through `open`, up and down by 1, 2 and 4 steps of some bits each, so by up to 7.
std::uint64_t spread(std::uint64_t f, std::uint64_t open, int step, std::uint64_t notFirst,
                     std::uint64_t notLast) {
  std::uint64_t up = f;
  std::uint64_t down = f;
  std::uint64_t passUp = open & notFirst;
  std::uint64_t passDown = open & notLast;
  for (int by = step; by < 8 * step; by *= 2) {
    up |= passUp & up << by;
    passUp &= passUp << by;
    down |= passDown & down >> by;
    passDown &= passDown >> by;
  }
  return up | down;
}

/// Spreads within a plane of constant x, once along z and once along y.
std::uint64_t spreadInPlane(std::uint64_t f, std::uint64_t open) {
  constexpr std::uint64_t kAll = ~std::uint64_t{0};
  return spread(spread(f, open, 1, kNotFirstZ, kNotLastZ), open, 8, kAll, kAll);
}

}  // namespace

int lowestVoxel(const LeafWords& voxels) {
  std::size_t x = 0;
  while (voxels[x] == 0) ++x;
  return 64 * static_cast<int>(x) + std::countr_zero(voxels[x]);
}

LeafWords neighboursOf(const LeafWords& voxels) {
  LeafWords near;
  for (std::size_t x = 0; x < 8; ++x) {
    const std::uint64_t v = voxels[x];
    near[x] = (v << 1 & kNotFirstZ) | (v >> 1 & kNotLastZ) | v << 8 | v >> 8;
    if (x > 0) near[x] |= voxels[x - 1];
    if (x < 7) near[x] |= voxels[x + 1];
  }
  return near;
}

LeafWords allNeighboursOf(const LeafWords& voxels) {
  LeafWords near;
  for (std::size_t x = 0; x < 8; ++x) {
    std::uint64_t v = voxels[x];
    if (x > 0) v |= voxels[x - 1];
    if (x < 7) v |= voxels[x + 1];
    v |= (v << 1 & kNotFirstZ) | (v >> 1 & kNotLastZ);
    near[x] = v | v << 8 | v >> 8;
  }
  return near;
}

LeafWords flooded(const LeafWords& seeds, const LeafWords& open) {
  LeafWords f;
  for (std::size_t x = 0; x < 8; ++x) f[x] = seeds[x] & open[x];
  for (LeafWords before = {}; before != f;) {
    before = f;
    for (std::size_t x = 0; x < 8; ++x)
      f[x] = spreadInPlane(x > 0 ? f[x] | (f[x - 1] & open[x]) : f[x], open[x]);
    for (std::size_t x = 7; x-- > 0;) f[x] = spreadInPlane(f[x] | (f[x + 1] & open[x]), open[x]);
  }
  return f;
}

}  // namespace vox
