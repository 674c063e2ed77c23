#pragma once

#include "libvox/grid/mark_brick.h"
#include "libvox/grid/voxel_means.h"

#include <vector>

namespace vox {

/// One thread's way of many samples into VoxelMeans: kernels add them to sums in a brick, and
/// collect() takes these, leaf by leaf, once a tile.
class MeanBrick {
 public:
  explicit MeanBrick(VoxelMeans& means) : writer_(means), sums_(MarkBrick::kMarks) {}

  /// MarkBrick::kMarks bytes, all 0 between calls of collect.
  std::uint8_t* marks() { return brick_.marks(); }
  /// The sums of the voxels of these marks, 0 where there is none.
  VoxelMeans::BrickSum* sums() { return sums_.data(); }

  /// Takes the sums of the marked voxels in a box that fits (MarkBrick). No other may be marked.
  void collect(const openvdb::Coord& low, const openvdb::Coord& high) {
    brick_.take(low, high, taken_);
    for (std::size_t k = 0; k < taken_.count; ++k)
      writer_.take(taken_.origins[k], taken_.words[k],
                   sums_.data() + MarkBrick::firstMark(taken_.origins[k]));
  }

  /// A single sample.
  void add(const openvdb::Coord& voxel, const Vec3d& vector) { writer_.add(voxel, vector); }

 private:
  VoxelMeans::Writer writer_;
  MarkBrick brick_;
  MarkBrick::Taken taken_;
  std::vector<VoxelMeans::BrickSum> sums_;
};

}  // namespace vox
