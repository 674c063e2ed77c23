// Colour grids on the active voxels of a mask.

#include "libvox/volume/color.h"

namespace vox {

openvdb::Vec3SGrid::Ptr colorGrid(const openvdb::MaskGrid& mask) {
  const openvdb::Vec3f background(0);
  auto tree = std::make_shared<openvdb::Vec3STree>(
      mask.tree(), background, openvdb::Vec3f(kPlainColor), openvdb::TopologyCopy());
  auto color = openvdb::Vec3SGrid::create(tree);
  color->setTransform(mask.transform().copy());
  color->setName("color");
  return color;
}

}  // namespace vox
