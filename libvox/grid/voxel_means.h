#pragma once

#include "libvox/core/types.h"
#include "libvox/grid/merge_leaf.h"

#include <openvdb/openvdb.h>
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
  Integer count = 0;  ///< of vectors

  template <class Other>
  void add(const VectorSum<Other>& more, Integer unit) {
    x += unit * more.x;
    y += unit * more.y;
    z += unit * more.z;
    count += more.count;
  }
};

/// Mean vectors of active voxels, of samples that come in whatever order: colours, or normals. The
/// sums are integers, so neither order nor threads show. Source: DESIGN section 8.
class VoxelMeans {
 public:
  /// @param voxels  all in leaves; must stay as they are
  explicit VoxelMeans(const openvdb::MaskTree& voxels);

  /// What one needs for as many voxels and leaves, in bytes.
  static std::uint64_t bytesFor(std::uint64_t voxels, std::uint64_t leaves);

  /// In units of 2^-kFractionBits: of 2^33 samples at least.
  using Sum = VectorSum<std::int64_t>;
  static constexpr int kFractionBits = 30;

  /// A voxel's share of a brick: in units of 2^-kBrickFractionBits, of at most kMostBrickSamples.
  using BrickSum = VectorSum<std::int32_t>;
  static constexpr int kBrickFractionBits = 18;
  static constexpr std::int32_t kMostBrickSamples = 1 << 12;

  /// One thread's way to the sums.
  class Writer {
   public:
    explicit Writer(VoxelMeans& means) : means_(means) {}
    /// A sample; of no consequence outside active voxels.
    /// @param vector  clamped to -1 .. 1
    void add(const openvdb::Coord& voxel, const Vec3d& vector);
    /// Takes the sums of some voxels of a leaf and sets them to 0.
    /// @param touched  these voxels; sums outside active ones are of no consequence
    /// @param sums     512, in the order of the leaf
    void take(const openvdb::Coord& leafOrigin, const LeafWords& touched, BrickSum* sums);

   private:
    bool find(const openvdb::Coord& leafOrigin);

    VoxelMeans& means_;
    openvdb::Coord pageOrigin_;
    const std::uint32_t* page_ = nullptr;  // of the sample before
    openvdb::Coord leafOrigin_;
    std::uint32_t leaf_ = kNoLeaf;
  };

  /// Gives voxels without a sample the mean of their neighbours, from voxel to voxel as far as it
  /// takes. After the last sample.
  void fillGaps();

  /// Mean of an active voxel; nothing if no sample is anywhere near.
  std::optional<Vec3d> meanOf(const openvdb::Coord& voxel) const;

  /// The sums of the active voxels of a leaf, in the order of the leaf; null if it has none.
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
  /// Numbers of the leaves in an inner node of 128^3 voxels.
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
  std::vector<std::size_t> firstSlots_;  // of each leaf
  std::unordered_map<openvdb::Coord, std::unique_ptr<Page>> pages_;
  std::unique_ptr<tbb::spin_mutex[]> locks_;  // of the sums of each leaf
  std::unique_ptr<Sum[], FreeSums> sums_;     // a slot for each voxel, leaf after leaf
};

}  // namespace vox
