// From black voxels to a fog volume.

#include "libvox/volume/density.h"

namespace vox {

openvdb::FloatGrid::Ptr densityGrid(const openvdb::MaskTree& mask, float value) {
  constexpr float kBackground = 0;
  auto tree =
      std::make_shared<openvdb::FloatTree>(mask, kBackground, value, openvdb::TopologyCopy());
  auto density = openvdb::FloatGrid::create(tree);
  density->setName("density");
  density->setGridClass(openvdb::GRID_FOG_VOLUME);
  return density;
}

}  // namespace vox
