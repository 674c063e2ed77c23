// Normals of the surfaces at the feet of voxels.

#include "libvox/pipeline/normals.h"

#include "libvox/core/memory.h"
#include "libvox/grid/openvdb.h"
#include "libvox/pipeline/feet.h"
#include "libvox/pipeline/grids.h"
#include "libvox/volume/vector_grid.h"

#include <array>
#include <limits>

namespace vox {
namespace {

openvdb::Vec3s directionOf(const Float3& v) {
  const float size = length(v);
  return size > std::numeric_limits<float>::min()
             ? openvdb::Vec3s(v[0] / size, v[1] / size, v[2] / size)
             : openvdb::Vec3s(0, 0, 0);
}

/// The normal of a triangle, of its edge or of its vertex, whichever the foot is on.
const Float3& normalAt(const TriangleCell& cell, float b, float c) {
  constexpr float kLeast = 1e-6F;
  const std::array<float, 3> weights = {1 - b - c, b, c};
  for (std::size_t i = 0; i < 3; ++i)
    if (weights[i] > 1 - kLeast) return cell.vertexNormals[i];
  for (std::size_t i = 0; i < 3; ++i)
    if (weights[(i + 2) % 3] < kLeast) return cell.edgeNormals[i];
  return cell.normal;
}

}  // namespace

openvdb::Vec3SGrid::Ptr makeNormalGrid(const openvdb::MaskGrid& mask,
                                       std::span<const PreparedSurface> surfaces,
                                       MemoryBudget& budget, Progress& progress) {
  budget.take(bytesOfVectors(mask.tree()), "the normal grid",
              "leave it out, use larger voxels, or raise --max-memory");
  auto grid = vectorGrid(mask, 0);
  grid->setName("normal");
  grid->setVectorType(openvdb::VEC_COVARIANT_NORMALIZE);
  const FootSurfaces feet = footSurfaces(surfaces);
  const auto normalOf = [&](const FootBins& bins, const FootPlace& at) {
    if (at.cell->kind == CellKind::kTriangle)
      return directionOf(normalAt(bins.triangle(*at.cell), at.a, at.b));
    const Biquadratic& surface = bins.newton(*at.cell).surface;
    const openvdb::Vec3s normal = directionOf(Jet(surface, at.a, at.b).normal());
    // At a corner where two sides are parallel, the surface near it has the normal.
    constexpr float kNear = 0.9F;
    if (normal != openvdb::Vec3s(0, 0, 0)) return normal;
    return directionOf(Jet(surface, kNear * at.a, kNear * at.b).normal());
  };
  visitFeet(
      feet, mask.tree(), budget, progress, 1,
      [&](const FootBins& bins, const openvdb::Coord& origin, const LeafFeet& leafFeet) {
        openvdb::Vec3s* const values = grid->tree().probeLeaf(origin)->buffer().data();
        leafFeet.forEachFound([&](unsigned i) { values[i] = normalOf(bins, leafFeet.place[i]); });
      });
  return grid;
}

}  // namespace vox
