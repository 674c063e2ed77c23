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

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

namespace vox {
namespace {

openvdb::Vec3f asFloats(const Vec3d& color) {
  return {static_cast<float>(color[0]), static_cast<float>(color[1]), static_cast<float>(color[2])};
}

/// The colours of the corners of a mesh; none if it has no colours.
std::vector<Vec3d> cornerColors(const PolygonMesh& mesh) {
  std::vector<Vec3d> colors;
  if (!mesh.pointColors.empty()) {
    for (const Index v : mesh.faceVertices) colors.push_back(mesh.pointColors[v].cast<double>());
  } else if (!mesh.faceColors.empty()) {
    for (Index f = 0; f < mesh.faceCount(); ++f)
      colors.insert(colors.end(), mesh.faceSize(f), mesh.faceColors[f].cast<double>());
  }
  return colors;
}

/// The colours of a mesh as a function of the place on its surface: in the part of a corner the
/// bilinear blend of the mean of the face, the middles of the two edges and the corner.
class MeshColors {
 public:
  /// @param corners  colours of the corners
  MeshColors(const PolygonMesh& mesh, std::vector<Vec3d> corners)
      : mesh_(mesh), corners_(std::move(corners)) {
    for (Index f = 0; f < mesh.faceCount(); ++f) {
      Vec3d sum = Vec3d::Zero();
      for (Index c = mesh.faceOffsets[f]; c < mesh.faceOffsets[f + 1]; ++c) {
        sum += corners_[c];
        faceOf_.push_back(f);
      }
      means_.emplace_back(sum / mesh.faceSize(f));
    }
  }

  /// At a place in the square of a corner (mesh/limit_piece.h).
  Vec3d at(Index corner, double u, double v) const {
    const Index f = faceOf_[corner];
    const Index first = mesh_.faceOffsets[f];
    const Index end = mesh_.faceOffsets[f + 1];
    const Vec3d& here = corners_[corner];
    const Vec3d& next = corners_[corner + 1 == end ? first : corner + 1];
    const Vec3d& previous = corners_[(corner == first ? end : corner) - 1];
    return (u * v) * means_[f] + (u * (1 - v) / 2) * (here + next) +
           ((1 - u) * v / 2) * (here + previous) + ((1 - u) * (1 - v)) * here;
  }
  /// In a triangle of three corners, with the weights of the second and the third.
  Vec3d at(const Index* corners, double b, double c) const {
    return (1 - b - c) * corners_[corners[0]] + b * corners_[corners[1]] + c * corners_[corners[2]];
  }

 private:
  const PolygonMesh& mesh_;
  std::vector<Vec3d> corners_;
  std::vector<Vec3d> means_;   // of each face
  std::vector<Index> faceOf_;  // of each corner
};

/// The colours of objects: of their textures at voxels, or of their meshes at feet.
class ObjectColors {
 public:
  ObjectColors(std::span<const PreparedSurface> surfaces, const openvdb::math::Transform& transform)
      : feet_(footSurfaces(surfaces)), transform_(transform) {
    std::uint32_t owners = 0;
    for (std::size_t s = 0; s < surfaces.size(); ++s) {
      const PolygonMesh& mesh = surfaces[s].base.mesh;
      std::vector<Vec3d> corners = cornerColors(mesh);
      Object& object = objects_.emplace_back();
      object.firstOwner = owners;
      if (!surfaces[s].texture && !corners.empty()) object.colors.emplace(mesh, std::move(corners));
      const std::size_t triangles = feet_.flat[s].triangles.faceCount();
      owners += static_cast<std::uint32_t>(triangles > 0 ? triangles : mesh.cornerCount());
    }
  }

  /// @param object  with a texture
  openvdb::Vec3f ofTexture(std::size_t object, const openvdb::Coord& voxel) const {
    const PlacedTexture& placed = *feet_.surfaces[object].texture;
    const Vec3d world(transform_.indexToWorld(voxel).asPointer());
    return asFloats(placed.texture.colorAt(placed.fromWorld * world));
  }
  bool hasMeshColors(std::size_t object) const { return objects_[object].colors.has_value(); }

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
  struct Object {
    std::uint32_t firstOwner = 0;  // of its cells
    std::optional<MeshColors> colors;
  };

  openvdb::Vec3f atFoot(const FootBins& bins, const FootPlace& at,
                        const openvdb::Coord& voxel) const {
    const auto next =
        std::upper_bound(objects_.begin(), objects_.end(), at.cell->owner,
                         [](std::uint32_t owner, const Object& o) { return owner < o.firstOwner; });
    const auto number = static_cast<std::size_t>(next - objects_.begin()) - 1;
    if (feet_.surfaces[number].texture) return ofTexture(number, voxel);
    const Object& object = objects_[number];
    if (!object.colors) return openvdb::Vec3f(kPlainColor);
    const std::uint32_t owner = at.cell->owner - object.firstOwner;
    if (at.cell->kind == CellKind::kTriangle)
      return asFloats(
          object.colors->at(&feet_.flat[number].corners[std::size_t{3} * owner], at.a, at.b));
    const SurfacePlace place = placeAt(bins, at);
    return asFloats(object.colors->at(owner, place.u, place.v));
  }

  FootSurfaces feet_;
  const openvdb::math::Transform& transform_;
  std::vector<Object> objects_;
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
  if (!texture) return std::nullopt;
  const Eigen::Affine3d fromWorld =
      texture->inWorld ? Eigen::Affine3d::Identity() : object.fromWorld;
  Box extent;
  for (const Index v : object.mesh.faceVertices) extent.add(fromWorld * object.mesh.points[v]);
  Eigen::Matrix3d back;
  for (int axis = 0; axis < 3; ++axis) back.col(axis) = turned(Vec3d::Unit(axis), inverse(turn));
  return PlacedTexture{SolidTexture(*texture, extent), fromWorld * Eigen::Affine3d(back)};
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
    else if (colors.hasMeshColors(0))
      colors.paintByFeet(*color, *voxels, kReachOfCrossed, budget, progress, part);
    else if (around)
      paint(*color, *voxels, [](const openvdb::Coord&) { return openvdb::Vec3f(kPlainColor); });
  }
  return color;
}

}  // namespace vox
