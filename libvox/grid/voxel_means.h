#pragma once

#include "libvox/core/types.h"
#include "libvox/grid/surface_grid.h"

#include <openvdb/openvdb.h>

#include <cstdint>
#include <unordered_map>
#include <vector>

namespace vox {

/// Mean colours of black voxels, from samples that fall into them in whatever order: the sums are
/// integers, so neither order nor threads show.
class ColorSums {
 public:
  /// @param voxels  all in leaves; must stay as they are
  explicit ColorSums(const openvdb::MaskTree& voxels);

  /// What one needs for as many voxels and leaves, in bytes.
  static std::uint64_t bytesFor(const openvdb::MaskTree& voxels);

  /// One thread's way to the sums.
  class Writer {
   public:
    explicit Writer(ColorSums& sums) : sums_(sums), leaves_(sums.voxels_) {}
    /// A sample; of no consequence outside black voxels.
    /// @param positionIndex  index space, within the range of the grid
    /// @param color          linear; clamped to 0 .. 1
    void add(const Vec3d& positionIndex, const Vec3d& color);

   private:
    ColorSums& sums_;
    openvdb::tree::ValueAccessor<const openvdb::MaskTree> leaves_;
    const openvdb::MaskTree::LeafNodeType* leaf_ = nullptr;  // of the sample before
    std::size_t first_ = 0;                                  // its first slot
  };

  /// Gives voxels without a sample the mean of their neighbours, from voxel to voxel as far as it
  /// takes. After the last sample.
  void fillGaps();

  /// Mean colour of a black voxel; kPlainColor if no sample is anywhere near.
  openvdb::Vec3f colorOf(const openvdb::Coord& voxel) const;

 private:
  using Leaf = openvdb::MaskTree::LeafNodeType;
  /// In units of 2^-20: of 2^43 samples at least.
  struct Sum {
    std::uint64_t red = 0;
    std::uint64_t green = 0;
    std::uint64_t blue = 0;
    std::uint64_t count = 0;
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
