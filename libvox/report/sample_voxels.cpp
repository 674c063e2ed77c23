// Some voxels of a tree, evenly spread over its order.

#include "libvox/report/sample_voxels.h"

namespace vox {
namespace {

/// Voxel i of a box, z fastest.
openvdb::Coord voxelOf(const openvdb::CoordBBox& box, std::uint64_t i) {
  const openvdb::Coord size = box.dim();
  const auto along = [&](int axis) { return static_cast<std::uint64_t>(size[axis]); };
  const auto part = [](std::uint64_t index) { return static_cast<openvdb::Int32>(index); };
  return box.min().offsetBy(part(i / along(2) / along(1)), part(i / along(2) % along(1)),
                            part(i % along(2)));
}

}  // namespace

std::vector<openvdb::Coord> sampleVoxels(const openvdb::MaskTree& voxels, std::uint64_t most) {
  const std::uint64_t count = voxels.activeVoxelCount();
  std::vector<openvdb::Coord> sample;
  if (count == 0 || most == 0) return sample;
  const std::uint64_t step = (count + most - 1) / most;
  std::uint64_t seen = 0;  // voxels before this value
  for (auto value = voxels.cbeginValueOn(); value; ++value) {
    const openvdb::CoordBBox box = value.getBoundingBox();
    const std::uint64_t volume = box.volume();
    for (std::uint64_t next = (seen + step - 1) / step * step; next < seen + volume; next += step)
      sample.push_back(voxelOf(box, next - seen));
    seen += volume;
  }
  return sample;
}

}  // namespace vox
