// Neighbouring voxels with too different values, leaf by leaf.

#include "libvox/inspect/steep_pairs.h"

#include "libvox/core/parallel.h"
#include "libvox/inspect/leaf_values.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <vector>

namespace vox {
namespace {

constexpr double kMostPerDistance = 1.1;
constexpr double kHalfRounding = 1.0 / 1024;  // two values, each off by 2^-11 of itself

using Words = std::array<std::uint64_t, 8>;  // bit y << 3 | z of word x

template <class Leaf>
Words activeWords(const Leaf& leaf) {
  Words words;
  for (openvdb::Index x = 0; x < 8; ++x)
    words[x] = leaf.getValueMask().template getWord<openvdb::Index64>(x);
  return words;
}

void addTo(SteepPairs& all, const SteepPairs& more) {
  if (more.count == 0) return;
  all.first = all.count == 0 ? more.first : std::min(all.first, more.first);
  all.count += more.count;
}

/// Collects the steep pairs of some leaves.
template <class Tree>
class PairSearch {
 public:
  using Leaf = typename Tree::LeafNodeType;
  using Value = typename Tree::ValueType;

  explicit PairSearch(const openvdb::Grid<Tree>& grid) : leaves_(grid.tree()) {
    const openvdb::Vec3d size = grid.voxelSize();
    for (std::size_t axis = 0; axis < 3; ++axis)
      limits_[axis] = kMostPerDistance * std::abs(size[static_cast<int>(axis)]);
    rounding_ = grid.saveFloatAsHalf() ? kHalfRounding : 0;
  }

  /// Looks at the pairs within a leaf, and at those with the next leaf along each axis.
  void search(const Leaf& leaf) {
    constexpr std::array<unsigned, 3> kSteps = {64, 8, 1};
    constexpr std::uint64_t kLastZ = 0x8080808080808080;
    constexpr std::uint64_t kLastY = 0xFF00000000000000;
    const LeafValues<Leaf> values(leaf);
    const Words active = activeWords(leaf);
    for (unsigned x = 0; x < 8; ++x) {
      const std::uint64_t a = active[x];
      if (x < 7) compare(leaf, values, x, a & active[x + 1], values, 0, kSteps[0]);
      compare(leaf, values, x, a & (a >> 8), values, 1, kSteps[1]);
      compare(leaf, values, x, a & (a >> 1) & ~kLastZ, values, 2, kSteps[2]);
    }
    for (int axis = 0; axis < 3; ++axis) {
      openvdb::Coord origin = leaf.origin();
      origin[axis] += static_cast<int>(Leaf::DIM);
      const Leaf* const next = leaves_.probeConstLeaf(origin);
      if (next == nullptr) continue;
      const LeafValues<Leaf> beyond(*next);
      const Words other = activeWords(*next);
      if (axis == 0) {
        compare(leaf, values, 7, active[7] & other[0], beyond, 0, -7 * 64);
        continue;
      }
      for (unsigned x = 0; x < 8; ++x)
        if (axis == 1)
          compare(leaf, values, x, active[x] & kLastY & (other[x] << 56), beyond, 1, -7 * 8);
        else
          compare(leaf, values, x, active[x] & kLastZ & (other[x] << 7), beyond, 2, -7);
    }
  }

  const SteepPairs& found() const { return found_; }

 private:
  /// @param pairs  voxels of word x that have an active neighbour
  /// @param step   from a voxel to its neighbour in `others`
  void compare(const Leaf& leaf, const LeafValues<Leaf>& values, unsigned x, std::uint64_t pairs,
               const LeafValues<Leaf>& others, std::size_t axis, int step) {
    for (; pairs != 0; pairs &= pairs - 1) {
      const unsigned at = x << 6 | static_cast<unsigned>(std::countr_zero(pairs));
      const auto a = static_cast<double>(values[at]);
      const auto b =
          static_cast<double>(others[static_cast<openvdb::Index>(static_cast<int>(at) + step)]);
      if (std::abs(a - b) <= limits_[axis]) continue;
      if (std::abs(a - b) <= limits_[axis] + rounding_ * std::max(std::abs(a), std::abs(b)))
        continue;
      addTo(found_, {1, leaf.offsetToGlobalCoord(at)});
    }
  }

  openvdb::tree::ValueAccessor<const Tree, false> leaves_;
  std::array<double, 3> limits_;  // along each axis, world units
  double rounding_;               // relative
  SteepPairs found_;
};

}  // namespace

template <class Grid>
SteepPairs steepPairs(const Grid& grid) {
  using Tree = typename Grid::TreeType;
  constexpr std::size_t kLeavesPerTask = 256;
  std::vector<const typename Tree::LeafNodeType*> leaves;
  leaves.reserve(grid.tree().leafCount());
  grid.tree().getNodes(leaves);
  std::vector<SteepPairs> parts((leaves.size() + kLeavesPerTask - 1) / kLeavesPerTask);
  parallelForEach(parts.size(), 1, [&](std::size_t i) {
    const std::size_t end = std::min(leaves.size(), (i + 1) * kLeavesPerTask);
    PairSearch<Tree> search(grid);
    for (std::size_t k = i * kLeavesPerTask; k < end; ++k) search.search(*leaves[k]);
    parts[i] = search.found();
  });
  SteepPairs all;
  for (const SteepPairs& part : parts) addTo(all, part);
  return all;
}

template SteepPairs steepPairs(const openvdb::FloatGrid& grid);
template SteepPairs steepPairs(const openvdb::DoubleGrid& grid);

}  // namespace vox
