#pragma once

#include "libvox/grid/openvdb.h"

#include <cstddef>
#include <span>
#include <vector>

namespace vox {

/// Active voxels of a leaf, or all voxels of a box: a tile.
struct ActiveBlock {
  openvdb::CoordBBox box;                        ///< inclusive
  const openvdb::util::NodeMask<3>* leafVoxels;  ///< of the leaf of this box; null: all are active
};

/// Finds the active voxel nearest to a place. Holds 32 bytes per block and 8 for the tree of boxes
/// above them (fours of neighbours along a Morton curve); finds in a microsecond or so.
class NearestActive {
 public:
  explicit NearestActive(std::vector<ActiveBlock> blocks);

  bool empty() const { return blocks_.empty(); }

  /// The active voxels of the leaf at an origin; null if there is no leaf. Thread-safe.
  const openvdb::util::NodeMask<3>* leafAt(const openvdb::Coord& origin) const;

  /// Squared Euclidean distance to the nearest active voxel, in voxels; infinite if there is none.
  /// Stops looking at the first distance that is not larger than `enoughSquared`. Thread-safe.
  double squaredDistance(const openvdb::Coord& from, double enoughSquared = 0) const;

 private:
  struct Search;
  void look(Search& search, std::size_t level, std::size_t node) const;

  std::vector<ActiveBlock> blocks_;
  std::vector<std::vector<openvdb::CoordBBox>> levels_;  ///< boxes of four of the level below
};

/// Active voxels of a leaf that are not active in another tree.
struct LeafSurplus {
  openvdb::Coord origin;
  openvdb::util::NodeMask<3> voxels;
};

/// Largest distance from any of these voxels to the nearest active voxel of another tree, in
/// voxels, Euclidean. Exact for leaves; within 1 % for boxes. Infinite if the other tree has no
/// active voxel. Parallel; the same for any number of threads.
double largestDistance(std::span<const LeafSurplus> leaves,
                       std::span<const openvdb::CoordBBox> boxes, const NearestActive& others);

}  // namespace vox
