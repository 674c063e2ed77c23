// Normals of the surfaces at the feet of voxels.

#include "libvox/pipeline/normals.h"

#include "libvox/core/memory.h"
#include "libvox/grid/openvdb.h"
#include "libvox/mesh/area_vector.h"
#include "libvox/pipeline/feet.h"
#include "libvox/pipeline/grids.h"
#include "libvox/volume/vector_grid.h"

#include <vector>

namespace vox {
namespace {

openvdb::Vec3s directionOf(const Float3& v) {
  const float size = length(v);
  return size > 0 ? openvdb::Vec3s(v[0] / size, v[1] / size, v[2] / size) : openvdb::Vec3s(0, 0, 0);
}

/// Unit normals of the faces of a mesh; 0 without area.
std::vector<openvdb::Vec3s> faceNormals(const PolygonMesh& mesh, const std::vector<Index>& faces) {
  std::vector<openvdb::Vec3s> normals;
  for (const Index f : faces) {
    const auto face = mesh.face(f);
    const Vec3d n = twiceAreaVector(
        face.size(), [&](std::size_t i) -> const Vec3d& { return mesh.points[face[i]]; });
    normals.emplace_back(openvdb::Vec3d(n.stableNormalized().data()));
  }
  return normals;
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
  std::vector<std::vector<openvdb::Vec3s>> flatNormals;
  for (std::size_t s = 0; s < surfaces.size(); ++s)
    flatNormals.push_back(faceNormals(surfaces[s].base.mesh, feet.flat[s].faces));
  const auto normalAt = [&](const FootBins& bins, const FootPlace& at) {
    if (at.cell->kind == CellKind::kTriangle) {
      const std::size_t s = feet.surfaceOf(at.cell->owner);
      return flatNormals[s][at.cell->owner - feet.firstOwner[s]];
    }
    return directionOf(Jet(bins.newton(*at.cell).surface, at.a, at.b).normal());
  };
  visitFeet(
      feet, mask.tree(), budget, progress, 1,
      [&](const FootBins& bins, const openvdb::Coord& origin, const LeafFeet& leafFeet) {
        openvdb::Vec3s* const values = grid->tree().probeLeaf(origin)->buffer().data();
        leafFeet.forEachFound([&](unsigned i) { values[i] = normalAt(bins, leafFeet.place[i]); });
      });
  return grid;
}

}  // namespace vox
