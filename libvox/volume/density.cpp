// From black voxels to a fog volume.

#include "libvox/volume/density.h"

namespace vox {

openvdb::FloatGrid::Ptr densityGrid(const openvdb::MaskGrid& mask) {
  constexpr float kBackground = 0;
  constexpr float kDensity = 1;
  auto tree = std::make_shared<openvdb::FloatTree>(mask.tree(), kBackground, kDensity,
                                                   openvdb::TopologyCopy());
  auto density = openvdb::FloatGrid::create(tree);
  density->setTransform(mask.transform().copy());
  density->setName("density");
  density->setGridClass(openvdb::GRID_FOG_VOLUME);
  return density;
}

}  // namespace vox
