// Colours of voxels: from which object, and from its texture or its mesh.

#include "libvox/pipeline/colors.h"

#include "libvox/core/memory.h"
#include "libvox/core/progress.h"
#include "libvox/grid/grow.h"
#include "libvox/grid/openvdb.h"
#include "libvox/pipeline/feet.h"
#include "libvox/pipeline/grids.h"
#include "libvox/volume/color.h"

#include <openvdb/tools/Prune.h>

#include <utility>
#include <vector>

namespace vox {
namespace {

openvdb::Vec3f asFloats(const Vec3d& color) {
  return {static_cast<float>(color[0]), static_cast<float>(color[1]), static_cast<float>(color[2])};
}
openvdb::Vec3f colorOf(const Vec4f& color) {
  return {color[0], color[1], color[2]};
}

/// The colours of objects: of their textures at voxels, or of their meshes at feet.
class ObjectColors {
 public:
  ObjectColors(std::span<const PreparedSurface> surfaces, const openvdb::math::Transform& transform)
      : feet_(footSurfaces(surfaces)), transform_(transform) {
    for (const PreparedSurface& surface : surfaces) colors_.emplace_back(surface);
  }

  /// @param object  with a texture
  openvdb::Vec3f ofTexture(std::size_t object, const openvdb::Coord& voxel) const {
    const PlacedTexture& placed = *feet_.surfaces[object].texture;
    const Vec3d world(transform_.indexToWorld(voxel).asPointer());
    return asFloats(placed.texture.colorAt(placed.fromWorld * world));
  }
  bool mayBeTransparent() const { return colors_[0].mayBeTransparent(); }

  /// Switches off the voxels of the only object whose foot is transparent.
  void cut(openvdb::MaskTree& voxels, const MemoryBudget& budget, Progress& progress) const {
    constexpr float kLeastCoverage = 0.5F;
    visitFeet(feet_, openvdb::MaskTree(voxels), kReachOfCrossed, budget, progress, 0,
              [&](const FootBins& bins, const openvdb::Coord& origin, const LeafFeet& feet) {
                auto* const leaf = voxels.probeLeaf(origin);
                feet.forEachFound([&](unsigned i) {
                  if (lookAtFoot(bins, feet.place[i])[3] < kLeastCoverage) leaf->setValueOff(i);
                });
              });
  }

  bool hasColorsByPlace(std::size_t object) const { return colors_[object].hasColors(); }

  /// Paints voxels with the colours of the objects that they are closest to.
  void paintByFeet(openvdb::Vec3SGrid& color, const openvdb::MaskTree& voxels, float reach,
                   const MemoryBudget& budget, Progress& progress, double part) const {
    visitFeet(feet_, voxels, reach, budget, progress, part,
              [&](const FootBins& bins, const openvdb::Coord& origin, const LeafFeet& feet) {
                auto* const leaf = color.tree().probeLeaf(origin);
                feet.forEachFound([&](unsigned i) {
                  leaf->buffer().data()[i] =
                      atFoot(bins, feet.place[i], leaf->offsetToGlobalCoord(i));
                });
              });
  }

 private:
  openvdb::Vec3f atFoot(const FootBins& bins, const FootPlace& at,
                        const openvdb::Coord& voxel) const {
    const std::size_t number = feet_.ownerOf(*at.cell).surface;
    if (feet_.surfaces[number].texture) return ofTexture(number, voxel);
    if (!colors_[number].hasColors()) return openvdb::Vec3f(kPlainColor);
    return colorOf(lookAtFoot(bins, at));
  }

  Vec4f lookAtFoot(const FootBins& bins, const FootPlace& at) const {
    const FootSurfaces::Owner owner = feet_.ownerOf(*at.cell);
    const SurfaceColors& colors = colors_[owner.surface];
    if (owner.triangle != nullptr) return colors.at(owner.triangle, at.a, at.b);
    const SurfacePlace place = placeAt(bins, at);
    return colors.at(owner.corner, place.u, place.v);
  }

  FootSurfaces feet_;
  const openvdb::math::Transform& transform_;
  std::vector<SurfaceColors> colors_;
};

/// The voxels of a mask, and one more on all sides.
openvdb::MaskGrid::Ptr grown(const openvdb::MaskGrid& mask) {
  auto voxels = std::make_shared<openvdb::MaskTree>(mask.tree());
  grow(*voxels);
  auto grid = openvdb::MaskGrid::create(voxels);
  grid->setTransform(mask.transform().copy());
  return grid;
}

}  // namespace

std::optional<PlacedTexture> placedTexture(const std::optional<TextureSpec>& texture,
                                           const SceneObject& object, Turn turn) {
  if (!texture || texture->kind == TextureKind::kImage) return std::nullopt;
  const Eigen::Affine3d fromWorld =
      texture->inWorld ? Eigen::Affine3d::Identity() : object.fromWorld;
  Box extent;
  for (const Index v : object.mesh.faceVertices) extent.add(fromWorld * object.mesh.points[v]);
  Eigen::Matrix3d back;
  for (int axis = 0; axis < 3; ++axis) back.col(axis) = turned(Vec3d::Unit(axis), inverse(turn));
  return PlacedTexture{SolidTexture(*texture, extent), fromWorld * Eigen::Affine3d(back)};
}

void cutTransparent(openvdb::MaskTree& voxels, const PreparedSurface& surface,
                    const MemoryBudget& budget, Progress& progress) {
  const ObjectColors colors({&surface, 1}, openvdb::math::Transform());
  if (!colors.mayBeTransparent()) return;
  colors.cut(voxels, budget, progress);
  openvdb::tools::pruneInactive(voxels);
}

openvdb::GridBase::Ptr makeColorGrid(const openvdb::MaskGrid& mask, const openvdb::MaskGrid* soft,
                                     std::span<const PreparedSurface> surfaces,
                                     MemoryBudget& budget, Progress& progress) {
  const openvdb::MaskGrid::ConstPtr around = soft != nullptr ? grown(*soft) : nullptr;
  const openvdb::MaskGrid& all = around ? *around : mask;
  budget.take(bytesOfVectors(all.tree()), "the color grid", kScatteredAdvice);
  auto color = colorGrid(all);
  if (around) {
    openvdb::MaskTree others(around->tree());
    others.topologyDifference(mask.tree());
    openvdb::tools::pruneInactive(others);
    ObjectColors(surfaces, color->transform())
        .paintByFeet(*color, others, kReachOfSoft + 1, budget, progress, 0.5);
  }
  const double part = (around ? 0.5 : 1) / static_cast<double>(surfaces.size());
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    progress.check();
    openvdb::MaskTree::ConstPtr voxels =
        surfaces[i].voxels ? surfaces[i].voxels : mask.constTreePtr();
    if (around) {
      auto kept = std::make_shared<openvdb::MaskTree>(*voxels);
      kept->topologyIntersection(around->tree());
      voxels = kept;
    }
    const ObjectColors colors(surfaces.subspan(i, 1), color->transform());
    if (surfaces[i].texture)
      paint(*color, *voxels,
            [&](const openvdb::Coord& voxel) { return colors.ofTexture(0, voxel); });
    else if (colors.hasColorsByPlace(0))
      colors.paintByFeet(*color, *voxels, kReachOfCrossed, budget, progress, part);
    else if (around)
      paint(*color, *voxels, [](const openvdb::Coord&) { return openvdb::Vec3f(kPlainColor); });
  }
  return color;
}

}  // namespace vox
