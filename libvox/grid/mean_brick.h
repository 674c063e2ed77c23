#pragma once

#include "libvox/grid/mark_brick.h"
#include "libvox/grid/voxel_means.h"

#include <vector>

namespace vox {

/// Buffer of one thread in front of a VoxelMeans, for many samples. Kernels add samples to sums in
/// a brick; collect() adds these sums to the VoxelMeans, leaf by leaf, once per tile.
class MeanBrick {
 public:
  explicit MeanBrick(VoxelMeans& means) : writer_(means), sums_(MarkBrick::kMarks) {}

  /// The marks of voxels that have samples: MarkBrick::kMarks bytes, all 0 after collect().
  std::uint8_t* marks() { return brick_.marks(); }
  /// The sums of the same voxels, in the order of the marks; 0 where nothing is marked.
  VoxelMeans::BrickSum* sums() { return sums_.data(); }

  /// Adds the sums of the marked voxels to the VoxelMeans; clears sums and marks.
  /// @param low, high  corners of a box of voxels that fits (MarkBrick::fits); only its leaves may
  ///   have marks
  void collect(const openvdb::Coord& low, const openvdb::Coord& high) {
    brick_.take(low, high, taken_);
    for (std::size_t k = 0; k < taken_.count; ++k)
      writer_.take(taken_.origins[k], taken_.words[k],
                   sums_.data() + MarkBrick::firstMark(taken_.origins[k]));
  }

  /// Adds a single sample.
  void add(const openvdb::Coord& voxel, const Vec3d& vector) { writer_.add(voxel, vector); }

 private:
  VoxelMeans::Writer writer_;
  MarkBrick brick_;
  MarkBrick::Taken taken_;
  std::vector<VoxelMeans::BrickSum> sums_;
};

}  // namespace vox
