#pragma once

#include "libvox/core/types.h"

#include <openvdb/openvdb.h>

#include <array>
#include <cstdint>
#include <unordered_map>
#include <vector>

namespace vox {

/// Sums of vectors, one for each active voxel of a mask: any number of threads add to them, and as
/// they are integers, in any order with the same result. Source: DESIGN section 8.
class VoxelSums {
 public:
  using Leaf = openvdb::MaskTree::LeafNodeType;

  /// What each component of an addend is rounded to.
  static constexpr double kUnit = 1.0 / (1 << 30);

  /// @param mask  stays as it is while this lives
  explicit VoxelSums(const openvdb::MaskTree& mask);

  /// Bytes for so many active voxels in so many leaves.
  static std::uint64_t bytesFor(std::uint64_t activeVoxels, std::uint64_t leaves) {
    constexpr std::uint64_t kPerLeaf = 64;
    return activeVoxels * sizeof(Sum) + leaves * kPerLeaf;
  }

  /// Where the voxels of a leaf are.
  struct Place {
    const Leaf* leaf = nullptr;
    std::size_t first = 0;
  };
  /// Of the leaf with this origin; no leaf if the mask has none there.
  Place placeOf(const openvdb::Coord& origin) const {
    const auto found = first_.find(origin);
    return found == first_.end() ? Place{} : found->second;
  }

  /// Adds a vector of components up to 1 to an active voxel, by its number in the leaf.
  void add(const Place& place, unsigned voxel, const Vec3d& vector);

  /// Sum of an active voxel, in any unit.
  Vec3d sum(const Place& place, unsigned voxel) const;

 private:
  using Sum = std::array<std::int64_t, 3>;
  struct OriginHash {
    std::size_t operator()(const openvdb::Coord& origin) const { return origin.hash<20>(); }
  };
  static std::size_t slotOf(const Place& place, unsigned voxel);

  std::unordered_map<openvdb::Coord, Place, OriginHash> first_;
  std::vector<Sum> sums_;  // of the active voxels of a leaf in their order
};

}  // namespace vox
