// Connectivity within a leaf and to the next, 64 voxels at a time.

#include "libvox/inspect/leaf_pieces.h"

#include "libvox/grid/openvdb.h"

#include <algorithm>

namespace vox {
namespace {

using openvdb::Coord;

constexpr std::uint64_t kLowZ = 0x0101010101010101ULL;
constexpr std::uint64_t kHighZ = kLowZ << 7U;

std::uint64_t alongZ(std::uint64_t word) {
  return word | (word & ~kHighZ) << 1U | (word & ~kLowZ) >> 1U;
}

std::uint64_t alongY(std::uint64_t word) {
  return word | word << 8U | word >> 8U;
}

/// The voxels of a leaf and their neighbours in it.
LeafWords grown(const LeafWords& words, Neighbours neighbours) {
  LeafWords wide;
  for (std::size_t x = 0; x < words.size(); ++x)
    wide[x] = neighbours == Neighbours::k26 ? alongY(alongZ(words[x]))
                                            : alongY(words[x]) | alongZ(words[x]);
  LeafWords result = wide;
  const LeafWords& sideways = neighbours == Neighbours::k26 ? wide : words;
  for (std::size_t x = 1; x < words.size(); ++x) {
    result[x] |= sideways[x - 1];
    result[x - 1] |= sideways[x];
  }
  return result;
}

/// The voxels that a piece touches in the neighbouring leaf in direction `d`.
LeafWords reach(const LeafWords& words, const Coord& d, Neighbours neighbours) {
  const bool wide = neighbours == Neighbours::k26;
  const auto sideways = [&](std::uint64_t word) {
    if (d.y() > 0) word >>= 56U;
    if (d.y() < 0) word <<= 56U;
    if (d.y() == 0 && wide) word = alongY(word);
    if (d.z() > 0) word = word >> 7U & kLowZ;
    if (d.z() < 0) word = word << 7U & kHighZ;
    if (d.z() == 0 && wide) word = alongZ(word);
    return word;
  };
  LeafWords result{};
  if (d.x() > 0) result.front() = sideways(words.back());
  if (d.x() < 0) result.back() = sideways(words.front());
  if (d.x() != 0) return result;
  for (std::size_t x = 0; x < words.size(); ++x) {
    std::uint64_t word = words[x];
    if (wide && x > 0) word |= words[x - 1];
    if (wide && x + 1 < words.size()) word |= words[x + 1];
    result[x] = sideways(word);
  }
  return result;
}

}  // namespace

LeafWords takePiece(LeafWords& left, Neighbours neighbours) {
  LeafWords piece{};
  const auto first = std::find_if(left.begin(), left.end(), [](auto word) { return word != 0; });
  piece[static_cast<std::size_t>(first - left.begin())] = *first & (~*first + 1);
  for (LeafWords before{}; before != piece;) {
    before = piece;
    piece = grown(piece, neighbours);
    for (std::size_t x = 0; x < piece.size(); ++x) piece[x] &= left[x];
  }
  for (std::size_t x = 0; x < piece.size(); ++x) left[x] &= ~piece[x];
  return piece;
}

bool touch(const LeafWords& words, const Coord& d, const LeafWords& other, Neighbours neighbours) {
  const LeafWords reached = reach(words, d, neighbours);
  for (std::size_t x = 0; x < other.size(); ++x)
    if ((reached[x] & other[x]) != 0) return true;
  return false;
}

Coord firstOf(const LeafWords& words) {
  const int voxel = lowestVoxel(words);
  return {voxel >> 6, voxel >> 3 & 7, voxel & 7};
}

}  // namespace vox
