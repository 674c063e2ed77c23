#pragma once

#include "libvox/grid/openvdb_fwd.h"
#include "libvox/inspect/diff.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace vox {

/// A set of connected voxels.
struct Component {
  std::uint64_t voxels = 0;
  VoxelIndex first{};  ///< lowest x, then y, then z
};

/// Components of the active voxels, neighbours through faces, edges and corners (26), by `first`.
/// Memory follows the leaves, some 150 bytes each. Parallel; the same for any number of threads.
/// @throws LimitError  2^32 pieces or more; the tiles are too large
std::vector<Component> activeComponents(const openvdb::MaskTree& voxels);

/// The components of the inactive voxels of a tree, connected face to face (6).
class Cavities {
 public:
  /// @throws LimitError  as activeComponents
  explicit Cavities(const openvdb::MaskTree& voxels);
  ~Cavities();
  Cavities(const Cavities&) = delete;
  Cavities& operator=(const Cavities&) = delete;

  /// Components that the active voxels close off from the space around them, by `first`.
  const std::vector<Component>& enclosed() const { return enclosed_; }

  /// True if a path of inactive voxels leads from an inactive voxel out of the bounding box.
  bool isOutside(const VoxelIndex& voxel) const;

 private:
  struct Labels;
  std::unique_ptr<Labels> labels_;
  std::vector<Component> enclosed_;
};

/// Spaces that the active voxels do not enclose, but would if they were one voxel thicker: the
/// shell around each has a hole of one or two voxels.
/// @param leastVoxels  smaller spaces are left out: folds and corners are full of them
std::vector<Component> leakingSpaces(const openvdb::MaskTree& voxels, std::uint64_t leastVoxels);

}  // namespace vox
