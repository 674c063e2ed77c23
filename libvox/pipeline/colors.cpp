// Colours of voxels: from which object, and from its texture or its mesh.

#include "libvox/pipeline/colors.h"

#include "libvox/core/memory.h"
#include "libvox/core/progress.h"
#include "libvox/grid/openvdb.h"
#include "libvox/pipeline/feet.h"
#include "libvox/pipeline/grids.h"
#include "libvox/volume/color.h"

#include <algorithm>
#include <utility>
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

void paintMeshColors(openvdb::Vec3SGrid& color, const openvdb::MaskTree& voxels,
                     const PreparedSurface& surface, const MeshColors& colors,
                     const MemoryBudget& budget, Progress& progress, double part) {
  const FootSurfaces feet = footSurfaces({&surface, 1});
  const auto colorAt = [&](const FootBins& bins, const FootPlace& at) {
    if (at.cell->kind == CellKind::kTriangle)
      return colors.at(&feet.flat[0].corners[std::size_t{3} * at.cell->owner], at.a, at.b);
    const SurfacePlace place = placeAt(bins, at);
    return colors.at(at.cell->owner, place.u, place.v);
  };
  visitFeet(feet, voxels, budget, progress, part,
            [&](const FootBins& bins, const openvdb::Coord& origin, const LeafFeet& leafFeet) {
              openvdb::Vec3s* const values = color.tree().probeLeaf(origin)->buffer().data();
              leafFeet.forEachFound(
                  [&](unsigned i) { values[i] = asFloats(colorAt(bins, leafFeet.place[i])); });
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
                                     MemoryBudget& budget, Progress& progress) {
  budget.take(bytesOfVectors(mask.tree()), "the color grid", kScatteredAdvice);
  auto color = colorGrid(mask);
  for (const PreparedSurface& surface : surfaces) {
    const openvdb::MaskTree& voxels = surface.voxels ? *surface.voxels : mask.tree();
    progress.check();
    std::vector<Vec3d> colors = cornerColors(surface.base.mesh);
    if (surface.texture)
      paintTexture(*color, voxels, *surface.texture);
    else if (!colors.empty())
      paintMeshColors(*color, voxels, surface, MeshColors(surface.base.mesh, std::move(colors)),
                      budget, progress, 1.0 / static_cast<double>(surfaces.size()));
  }
  return color;
}

}  // namespace vox
