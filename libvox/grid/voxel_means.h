#pragma once

#include "libvox/core/types.h"

#include <openvdb/openvdb.h>

#include <cstdint>
#include <optional>
#include <unordered_map>
#include <vector>

namespace vox {

/// Mean vectors of black voxels, of samples that come in whatever order: colours, or normals. The
/// sums are integers, so neither order nor threads show. Source: DESIGN section 8.
class VoxelMeans {
 public:
  /// @param voxels  all in leaves; must stay as they are
  explicit VoxelMeans(const openvdb::MaskTree& voxels);

  /// What one needs for as many voxels and leaves, in bytes.
  static std::uint64_t bytesFor(std::uint64_t voxels, std::uint64_t leaves);

  /// One thread's way to the sums.
  class Writer {
   public:
    explicit Writer(VoxelMeans& means) : means_(means), leaves_(means.voxels_) {}
    /// A sample; of no consequence outside black voxels.
    /// @param vector  clamped to -1 .. 1
    void add(const openvdb::Coord& voxel, const Vec3d& vector);

   private:
    VoxelMeans& means_;
    openvdb::tree::ValueAccessor<const openvdb::MaskTree> leaves_;
    const openvdb::MaskTree::LeafNodeType* leaf_ = nullptr;  // of the sample before
    std::size_t first_ = 0;                                  // its first slot
  };

  /// Gives voxels without a sample the mean of their neighbours, from voxel to voxel as far as it
  /// takes. After the last sample.
  void fillGaps();

  /// Mean of a black voxel; nothing if no sample is anywhere near.
  std::optional<Vec3d> meanOf(const openvdb::Coord& voxel) const;

 private:
  using Leaf = openvdb::MaskTree::LeafNodeType;
  /// In units of 2^-30: of 2^33 samples at least.
  struct Sum {
    std::int64_t x = 0;
    std::int64_t y = 0;
    std::int64_t z = 0;
    std::int64_t count = 0;
  };
  struct Gap {
    openvdb::Coord voxel;
    std::size_t slot;
  };
  using Accessor = openvdb::tree::ValueAccessor<const openvdb::MaskTree>;

  /// Null if the voxel is not black.
  const Sum* sumAt(const Leaf* leaf, const openvdb::Coord& voxel) const;
  Sum meanOfNeighbours(const Accessor& leaves, const openvdb::Coord& voxel) const;
  std::vector<Gap> gaps() const;

  const openvdb::MaskTree& voxels_;
  std::unordered_map<const Leaf*, std::size_t> firstSlots_;
  std::vector<Sum> sums_;  // one a voxel: leaf after leaf, in the order of the leaf
};

}  // namespace vox
