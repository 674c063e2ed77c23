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

/// Number of bits set in each byte.
std::uint64_t countOfBytes(std::uint64_t bits) {
  bits -= bits >> 1 & 0x5555555555555555;
  bits = (bits & 0x3333333333333333) + (bits >> 2 & 0x3333333333333333);
  return (bits + (bits >> 4)) & 0x0F0F0F0F0F0F0F0F;
}

}  // namespace

std::uint64_t countOf(const LeafWords& voxels) {
  std::uint64_t bytes = 0;  // each at most 64, so the sum of all needs two bytes
  for (const std::uint64_t word : voxels) bytes += countOfBytes(word);
  constexpr std::uint64_t kEvenBytes = 0x00FF00FF00FF00FF;
  const std::uint64_t pairs = (bytes & kEvenBytes) + (bytes >> 8 & kEvenBytes);
  return pairs * 0x0001000100010001 >> 48;
}

LeafBox boxOf(const LeafWords& voxels) {
  LeafBox box;
  int& x = box.low[0] = 0;
  while (voxels[static_cast<std::size_t>(x)] == 0) ++x;
  int& lastX = box.high[0] = 7;
  while (voxels[static_cast<std::size_t>(lastX)] == 0) --lastX;
  std::uint64_t yz = 0;
  for (const std::uint64_t word : voxels) yz |= word;
  box.low[1] = std::countr_zero(yz) / 8;
  box.high[1] = 7 - std::countl_zero(yz) / 8;
  std::uint64_t z = yz | yz >> 32;
  z |= z >> 16;
  z = (z | z >> 8) & 0xFF;
  box.low[2] = std::countr_zero(z);
  box.high[2] = 63 - std::countl_zero(z);
  return box;
}

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
