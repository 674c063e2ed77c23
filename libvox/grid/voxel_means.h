#pragma once

#include "libvox/core/types.h"
#include "libvox/grid/merge_leaf.h"
#include "libvox/grid/openvdb.h"

#include <tbb/spin_mutex.h>

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

namespace vox {

/// A sum of vectors in fixed point.
template <class Integer>
struct VectorSum {
  Integer x = 0;
  Integer y = 0;
  Integer z = 0;
  Integer count = 0;  ///< number of vectors

  template <class Other>
  void add(const VectorSum<Other>& more, Integer unit) {
    x += unit * more.x;
    y += unit * more.y;
    z += unit * more.z;
    count += more.count;
  }
};

/// Mean vectors (colours, or normals) of samples at active voxels. The sums are integers, so the
/// means depend neither on the order of the samples nor on threads. Source: DESIGN section 12.
class VoxelMeans {
 public:
  /// @param voxels  the active voxels, without active tiles; the tree must stay alive and unchanged
  explicit VoxelMeans(const openvdb::MaskTree& voxels);

  /// Bytes of an object for so many voxels and leaves.
  static std::uint64_t bytesFor(std::uint64_t voxels, std::uint64_t leaves);

  /// The sum of a voxel, in units of 2^-kFractionBits. It has room for 2^33 samples.
  using Sum = VectorSum<std::int64_t>;
  static constexpr int kFractionBits = 30;

  /// The sum of a voxel in a MeanBrick, in units of 2^-kBrickFractionBits. It has room for
  /// kMostBrickSamples samples.
  using BrickSum = VectorSum<std::int32_t>;
  static constexpr int kBrickFractionBits = 18;
  static constexpr std::int32_t kMostBrickSamples = 1 << 12;

  /// Adds samples. One object per thread; objects of different threads may work at the same time.
  class Writer {
   public:
    explicit Writer(VoxelMeans& means) : means_(means) {}
    /// Adds a sample; ignores it if the voxel is not active.
    /// @param vector  its coordinates are clamped to -1 .. 1
    void add(const openvdb::Coord& voxel, const Vec3d& vector);
    /// Adds the sums of some voxels of a leaf, and sets these sums to 0.
    /// @param touched  the voxels; those that are not active are ignored
    /// @param sums     512 of them, in the order of the leaf
    void take(const openvdb::Coord& leafOrigin, const LeafWords& touched, BrickSum* sums);

   private:
    bool find(const openvdb::Coord& leafOrigin);

    VoxelMeans& means_;
    openvdb::Coord pageOrigin_;
    const std::uint32_t* page_ = nullptr;  // page of the last sample
    openvdb::Coord leafOrigin_;
    std::uint32_t leaf_ = kNoLeaf;
  };

  /// Gives each voxel without a sample the mean of its neighbours' means. Repeats until no voxel
  /// changes, so that means spread from voxel to voxel. Call it after the last sample. Parallel;
  /// result independent of thread count.
  void fillGaps();

  /// Mean of a voxel; nothing if it is not active or has no sample. After fillGaps only voxels that
  /// are connected to no sample have none.
  std::optional<Vec3d> meanOf(const openvdb::Coord& voxel) const;

  /// The sums of the active voxels of a leaf, in the order of the leaf; null if there is no such
  /// leaf.
  const Sum* sumsOf(const openvdb::Coord& leafOrigin) const;

 private:
  using Leaf = openvdb::MaskTree::LeafNodeType;
  struct Gap {
    openvdb::Coord voxel;
    std::size_t slot;
  };
  struct FreeSums {
    void operator()(Sum* sums) const;
  };
  /// Numbers of the leaves of an inner node of 128^3 voxels, or kNoLeaf.
  static constexpr int kPageLog2 = 7;
  static constexpr std::size_t kPageLeaves = std::size_t{1} << (3 * (kPageLog2 - 3));
  using Page = std::array<std::uint32_t, kPageLeaves>;
  static constexpr std::uint32_t kNoLeaf = UINT32_MAX;

  static openvdb::Coord pageOriginOf(const openvdb::Coord& voxel) {
    return (voxel >> kPageLog2) << kPageLog2;
  }
  static std::size_t placeInPage(const openvdb::Coord& leafOrigin);
  const std::uint32_t* pageAt(const openvdb::Coord& pageOrigin) const;
  std::uint32_t leafAt(const openvdb::Coord& leafOrigin) const;
  /// Null if the voxel is not active.
  const Sum* sumAt(const openvdb::Coord& voxel) const;
  Sum meanOfNeighbours(const openvdb::Coord& voxel) const;
  std::vector<Gap> gaps() const;

  std::vector<const Leaf*> leaves_;
  std::vector<std::size_t> firstSlots_;  // slot of the first active voxel of each leaf
  std::unordered_map<openvdb::Coord, std::unique_ptr<Page>> pages_;
  std::unique_ptr<tbb::spin_mutex[]> locks_;  // one for the sums of each leaf
  std::unique_ptr<Sum[], FreeSums> sums_;     // a slot for each voxel, leaf after leaf
};

}  // namespace vox
