// Distances change by at most a voxel from voxel to voxel. So the neighbours of a voxel that is
// well inside a band are in the band; one that is not active is a hole.

#include "libvox/foot/band_holes.h"

#include "libvox/core/parallel.h"
#include "libvox/grid/leaf_words.h"
#include "libvox/grid/openvdb.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <vector>

namespace vox {
namespace {

using openvdb::Coord;
using Leaf = openvdb::FloatTree::LeafNodeType;

constexpr double kSurelyNeighbour = 1.1;  // voxels: a step, and what distances are off by

class Holes {
 public:
  Holes(openvdb::FloatTree& band, const BandOptions& options)
      : band_(band),
        lowest_(static_cast<float>((kSurelyNeighbour - options.in) * options.voxelSize)),
        highest_(static_cast<float>((options.out - kSurelyNeighbour) * options.voxelSize)),
        least_(-inBand(options.unsignedDistance ? options.halfThickness : options.in,
                       options.voxelSize)),
        most_(inBand(options.out, options.voxelSize)) {}

  /// The voxels that are not active, but neighbours of some well inside the band; ascending.
  std::vector<Coord> find() const {
    std::vector<const Leaf*> leaves;
    band_.getNodes(leaves);
    std::vector<std::vector<Coord>> found(leaves.size());
    constexpr std::size_t kLeavesPerTask = 64;
    parallelForEach(leaves.size(), kLeavesPerTask,
                    [&](std::size_t l) { found[l] = besideLeaf(*leaves[l]); });
    std::vector<Coord> all;
    for (const auto& some : found) all.insert(all.end(), some.begin(), some.end());
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
  }

  /// The distance of a hole, from those around it. World units.
  float estimate(const Coord& at) const {
    double between = 0, beyond = 0, beside = 0;
    int pairs = 0, lines = 0, neighbours = 0;
    for (int axis = 0; axis < 3; ++axis) {
      std::array<float, 2> near = {};
      std::array<bool, 2> has = {};
      for (int side = 0; side < 2; ++side) {
        const Coord step = stepOf(axis, side);
        float far = 0;
        has[side] = band_.probeValue(at + step, near[side]);
        if (!has[side]) continue;
        beside += near[side];
        ++neighbours;
        if (!band_.probeValue(at + step + step, far)) continue;
        beyond += 2 * near[side] - far;
        ++lines;
      }
      if (!has[0] || !has[1]) continue;
      between += (near[0] + near[1]) / 2;
      ++pairs;
    }
    const double mean = pairs > 0   ? between / pairs
                        : lines > 0 ? beyond / lines
                                    : beside / std::max(neighbours, 1);
    return std::clamp(static_cast<float>(mean), least_, most_);
  }

 private:
  /// The largest distance that a band of some width holds.
  static float inBand(double width, double voxelSize) {
    return width > 0 ? std::nextafter(static_cast<float>(width * voxelSize), 0.0F) : 0;
  }

  static Coord stepOf(int axis, int side) {
    Coord step(0, 0, 0);
    step[axis] = side == 0 ? -1 : 1;
    return step;
  }

  std::vector<Coord> besideLeaf(const Leaf& leaf) const {
    const LeafWords active = activeWords(leaf);
    LeafWords within = {};
    for (openvdb::Index i = 0; i < Leaf::SIZE; ++i) {
      const float value = leaf.buffer().data()[i];
      within[i >> 6] |= std::uint64_t{value >= lowest_ && value <= highest_} << (i & 63U);
    }
    for (unsigned x = 0; x < 8; ++x) within[x] &= active[x];
    std::vector<Coord> found;
    const LeafWords beside = neighboursOf(within);
    for (unsigned x = 0; x < 8; ++x)
      for (std::uint64_t left = beside[x] & ~active[x]; left != 0; left &= left - 1)
        found.push_back(coordOf(leaf, x, left));
    for (int axis = 0; axis < 3; ++axis)
      for (int side = 0; side < 2; ++side) addAcross(leaf, within, axis, side, found);
    return found;
  }

  /// Adds the holes in the next leaf that lie beside voxels of this one.
  void addAcross(const Leaf& leaf, const LeafWords& within, int axis, int side,
                 std::vector<Coord>& found) const {
    constexpr std::uint64_t kFirstY = 0xFF, kFirstZ = 0x0101010101010101;
    const std::uint64_t first = axis == 1 ? kFirstY : kFirstZ;
    const std::uint64_t face =
        axis == 0 ? ~std::uint64_t{0} : first << (side == 0 ? 0 : (axis == 1 ? 56 : 7));
    const Coord step = stepOf(axis, side);
    const Leaf* next = nullptr;
    bool isKnown = false;
    for (unsigned x = 0; x < 8; ++x) {
      if (axis == 0 && x != (side == 0 ? 0U : 7U)) continue;
      for (std::uint64_t left = within[x] & face; left != 0; left &= left - 1) {
        if (!isKnown) next = band_.probeConstLeaf(leaf.origin() + (step << 3));
        isKnown = true;
        const Coord at = coordOf(leaf, x, left) + step;
        if (next == nullptr || !next->isValueOn(at)) found.push_back(at);
      }
    }
  }

  static Coord coordOf(const Leaf& leaf, unsigned x, std::uint64_t bits) {
    return leaf.offsetToGlobalCoord(x << 6 | static_cast<unsigned>(std::countr_zero(bits)));
  }

  const openvdb::FloatTree& band_;
  float lowest_, highest_;  // values well inside the band
  float least_, most_;      // values in the band
};

}  // namespace

std::size_t closeHoles(openvdb::FloatTree& band, const BandOptions& options) {
  constexpr int kMostRounds = 3;  // each closes a voxel from all sides
  const Holes holes(band, options);
  std::size_t count = 0;
  for (int round = 0; round < kMostRounds; ++round) {
    const std::vector<Coord> found = holes.find();
    if (found.empty()) break;
    std::vector<float> values(found.size());
    for (std::size_t i = 0; i < found.size(); ++i) values[i] = holes.estimate(found[i]);
    for (std::size_t i = 0; i < found.size(); ++i) band.setValueOn(found[i], values[i]);
    count += found.size();
  }
  return count;
}

}  // namespace vox
