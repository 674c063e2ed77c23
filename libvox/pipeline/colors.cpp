// Colours of voxels: from which object, and from its texture or its mesh.

#include "libvox/pipeline/colors.h"

#include "libvox/core/memory.h"
#include "libvox/core/progress.h"
#include "libvox/grid/openvdb.h"
#include "libvox/grid/voxel_means.h"
#include "libvox/pipeline/grids.h"
#include "libvox/pipeline/surface_colors.h"
#include "libvox/subdivide/colored_surface.h"
#include "libvox/volume/color.h"

#include <vector>

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

/// Level whose polygons are sampled; empty if vertices are. Polygons refined to other limits than
/// levels lie near those of a few levels; a voxel that these miss takes the mean of its neighbours.
std::optional<int> sampledLevel(const ConversionWay& way) {
  constexpr int kNearEnough = 3;
  if (!way.polygons) return std::nullopt;
  return way.until.levels.value_or(kNearEnough);
}

/// @param colors  of the corners
void paintMeshColors(openvdb::Vec3SGrid& color, const openvdb::MaskTree& voxels,
                     const PreparedSurface& surface, std::span<const Vec3d> colors,
                     MemoryBudget budget, const Progress& progress) {
  budget.take(
      VoxelMeans::bytesFor(voxels.activeVoxelCount(), voxels.leafCount()) + colors.size_bytes(),
      "the sums of colours", kScatteredAdvice);
  VoxelMeans means(voxels);
  sampleColors(surface.base, colors, sampledLevel(surface.way), budget, progress, means);
  means.fillGaps();
  paint(color, voxels, [&](const openvdb::Coord& voxel) {
    return asFloats(means.meanOf(voxel).value_or(Vec3d::Constant(kPlainColor)));
  });
}

}  // namespace

std::optional<PlacedTexture> placedTexture(const std::optional<TextureSpec>& texture,
                                           const SceneObject& object, Turn turn) {
  if (!texture) return std::nullopt;
  const Eigen::Affine3d fromWorld =
      texture->inWorld ? Eigen::Affine3d::Identity() : object.fromWorld;
  Box extent;
  for (const Index v : object.mesh.faceVertices) extent.add(fromWorld * object.mesh.points[v]);
  Eigen::Matrix3d back;
  for (int axis = 0; axis < 3; ++axis) back.col(axis) = turned(Vec3d::Unit(axis), inverse(turn));
  return PlacedTexture{SolidTexture(*texture, extent), fromWorld * Eigen::Affine3d(back)};
}

openvdb::GridBase::Ptr makeColorGrid(const openvdb::MaskGrid& mask,
                                     std::span<const PreparedSurface> surfaces,
                                     MemoryBudget& budget, const Progress& progress) {
  budget.take(bytesOfVectors(mask.tree()), "the color grid", kScatteredAdvice);
  auto color = colorGrid(mask);
  for (const PreparedSurface& surface : surfaces) {
    const openvdb::MaskTree& voxels = surface.voxels ? *surface.voxels : mask.tree();
    progress.check();
    const std::vector<Vec3d> colors = cornerColors(surface.base.mesh);
    if (surface.texture)
      paintTexture(*color, voxels, *surface.texture);
    else if (!colors.empty())
      paintMeshColors(*color, voxels, surface, colors, budget, progress);
  }
  return color;
}

}  // namespace vox
