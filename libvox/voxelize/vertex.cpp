// Vertex conversion (Cohen, Kaufman & Wang 1994, section 5).

#include "libvox/voxelize/vertex.h"

#include "libvox/core/parallel.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <vector>

namespace vox {
namespace {

constexpr std::size_t kPointsPerTask = 16384;

using openvdb::Coord;

constexpr int kLeafLog2 = 3;
constexpr int kLowerLog2 = 7;
constexpr int kUpperLog2 = 12;

/// Origins of the nodes of side 2^log2 that hold some voxels, each once.
std::vector<Coord> originsOf(const std::vector<Coord>& voxels, int log2) {
  std::vector<Coord> origins;
  for (const Coord& voxel : voxels) {
    const Coord origin = (voxel >> static_cast<std::size_t>(log2))
                         << static_cast<std::size_t>(log2);
    if (origins.empty() || origins.back() != origin) origins.push_back(origin);
  }
  sortInParallel(origins);
  origins.erase(std::unique(origins.begin(), origins.end()), origins.end());
  return origins;
}

/// Leaf origins of a run of positions; neighbours in the run mostly share theirs.
void appendLeaves(std::span<const Vec3d> positionsIndex, std::vector<Coord>& leaves) {
  for (const Vec3d& position : positionsIndex) {
    const Coord leaf = (voxelOf(position) >> kLeafLog2) << kLeafLog2;
    if (leaves.empty() || leaves.back() != leaf) leaves.push_back(leaf);
  }
}

}  // namespace

TreeFootprint footprintOf(std::span<const Vec3d> positionsIndex) {
  tbb::enumerable_thread_specific<std::vector<Coord>> parts;
  forParts(positionsIndex.size(), kPointsPerTask, [&](std::size_t begin, std::size_t end) {
    appendLeaves(positionsIndex.subspan(begin, end - begin), parts.local());
  });
  std::vector<Coord> leaves;
  for (const auto& part : parts) leaves.insert(leaves.end(), part.begin(), part.end());
  leaves = originsOf(leaves, kLeafLog2);
  const std::vector<Coord> lower = originsOf(leaves, kLowerLog2);
  return {leaves.size(), lower.size(), originsOf(lower, kUpperLog2).size()};
}

void markVertices(std::span<const Vec3d> positionsIndex, openvdb::MaskGrid& mask) {
  tbb::enumerable_thread_specific<openvdb::MaskTree> trees;
  forParts(positionsIndex.size(), kPointsPerTask, [&](std::size_t begin, std::size_t end) {
    openvdb::tree::ValueAccessor<openvdb::MaskTree> voxels(trees.local());
    for (std::size_t i = begin; i != end; ++i) voxels.setValueOn(voxelOf(positionsIndex[i]));
  });
  trees.combine_each([&](openvdb::MaskTree& tree) { mask.tree().merge(tree); });
}

}  // namespace vox
