// Colour grids on the active voxels of a mask.

#include "libvox/volume/color.h"

#include "libvox/volume/vector_grid.h"

namespace vox {

openvdb::Vec3SGrid::Ptr colorGrid(const openvdb::MaskGrid& mask) {
  auto color = vectorGrid(mask, kPlainColor);
  color->setName("color");
  return color;
}

}  // namespace vox
