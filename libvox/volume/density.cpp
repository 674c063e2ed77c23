// Fog volumes on the active voxels of a mask.

#include "libvox/volume/density.h"

#include "libvox/grid/openvdb.h"

#include <algorithm>
#include <utility>

namespace vox {

double densityValue(std::optional<double> gain, Target target, double voxelSize) {
  constexpr double kDepthOfVoxel = 6;
  constexpr double kMost = 60000;  // what half floats hold
  if (gain) return *gain;
  if (target == Target::kHoudini) return 1;
  return std::clamp(kDepthOfVoxel / voxelSize, 1.0, kMost);
}

openvdb::FloatGrid::Ptr densityGrid(const openvdb::MaskTree& mask, float value) {
  constexpr float kBackground = 0;
  auto tree =
      std::make_shared<openvdb::FloatTree>(mask, kBackground, value, openvdb::TopologyCopy());
  return densityGrid(std::move(tree));
}

openvdb::FloatGrid::Ptr densityGrid(openvdb::FloatTree::Ptr tree) {
  auto density = openvdb::FloatGrid::create(tree);
  density->setName("density");
  density->setGridClass(openvdb::GRID_FOG_VOLUME);
  return density;
}

}  // namespace vox
