// Colours of voxels: whose they are and what they are painted with.

#include "libvox/pipeline/colors.h"

#include "libvox/pipeline/grids.h"
#include "libvox/volume/color.h"

namespace vox {
namespace {

openvdb::Vec3f asFloats(const Vec3d& color) {
  return {static_cast<float>(color[0]), static_cast<float>(color[1]), static_cast<float>(color[2])};
}

void paintTexture(openvdb::Vec3SGrid& color, const openvdb::MaskTree& voxels,
                  const PlacedTexture& placed) {
  const openvdb::math::Transform& transform = color.transform();
  paint(color, voxels, [&](const openvdb::Coord& voxel) {
    const Vec3d world(transform.indexToWorld(voxel).asPointer());
    return asFloats(placed.texture.colorAt(placed.fromWorld * world));
  });
}

}  // namespace

std::optional<PlacedTexture> textureOf(const SceneObject& object,
                                       const std::optional<TextureSpec>& asked) {
  const std::optional<TextureSpec>& spec = asked ? asked : object.texture;
  if (!spec) return std::nullopt;
  const Eigen::Affine3d fromWorld = spec->inWorld ? Eigen::Affine3d::Identity() : object.fromWorld;
  Box extent;
  for (const Index v : object.mesh.faceVertices) extent.add(fromWorld * object.mesh.points[v]);
  return PlacedTexture{SolidTexture(*spec, extent), fromWorld};
}

openvdb::GridBase::Ptr makeColorGrid(const openvdb::MaskGrid& mask,
                                     std::span<const PreparedSurface> surfaces,
                                     MemoryBudget& budget) {
  budget.take(bytesOfGrid<openvdb::Vec3STree>(mask.tree()), "the color grid", kScatteredAdvice);
  auto color = colorGrid(mask);
  for (const PreparedSurface& surface : surfaces) {
    const openvdb::MaskTree& voxels = surface.voxels ? *surface.voxels : mask.tree();
    if (surface.texture) paintTexture(*color, voxels, *surface.texture);
  }
  return color;
}

}  // namespace vox
