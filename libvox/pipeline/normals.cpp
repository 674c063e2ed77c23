// Normals of the surfaces at the feet of voxels.

#include "libvox/pipeline/normals.h"

#include "libvox/core/memory.h"
#include "libvox/grid/openvdb.h"
#include "libvox/pipeline/feet.h"
#include "libvox/pipeline/grids.h"
#include "libvox/volume/vector_grid.h"

#include <limits>

namespace vox {
namespace {

openvdb::Vec3s directionOf(const Float3& v) {
  const float size = length(v);
  return size > std::numeric_limits<float>::min()
             ? openvdb::Vec3s(v[0] / size, v[1] / size, v[2] / size)
             : openvdb::Vec3s(0, 0, 0);
}

}  // namespace

openvdb::Vec3SGrid::Ptr makeNormalGrid(const openvdb::MaskGrid& voxels,
                                       std::span<const PreparedSurface> surfaces, float reach,
                                       MemoryBudget& budget, Progress& progress) {
  budget.take(bytesOfVectors(voxels.tree()), "the normal grid",
              "leave it out, use larger voxels, or raise --max-memory");
  auto grid = vectorGrid(voxels, 0);
  grid->setName("normal");
  grid->setVectorType(openvdb::VEC_COVARIANT_NORMALIZE);
  const FootSurfaces feet = footSurfaces(surfaces);
  visitFeet(feet, voxels.tree(), reach, budget, progress, 1,
            [&](const FootBins& bins, const openvdb::Coord& origin, const LeafFeet& leafFeet) {
              openvdb::Vec3s* const values = grid->tree().probeLeaf(origin)->buffer().data();
              leafFeet.forEachFound(
                  [&](unsigned i) { values[i] = directionOf(normalAt(bins, leafFeet.place[i])); });
            });
  return grid;
}

}  // namespace vox
