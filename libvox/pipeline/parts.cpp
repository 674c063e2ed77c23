// Which part of the model each voxel belongs to.

#include "libvox/pipeline/parts.h"

#include "libvox/core/memory.h"
#include "libvox/core/progress.h"
#include "libvox/grid/openvdb.h"
#include "libvox/pipeline/feet.h"
#include "libvox/pipeline/grids.h"
#include "libvox/pipeline/part_numbers.h"
#include "libvox/volume/spread_labels.h"

#include <vector>

namespace vox {

openvdb::GridBase::Ptr makePartGrid(const openvdb::MaskGrid& mask, const openvdb::MaskTree* voxels,
                                    std::span<const PreparedSurface> surfaces,
                                    std::span<const std::string> names, MemoryBudget& budget,
                                    Progress& progress) {
  openvdb::MaskTree all(voxels != nullptr ? *voxels : mask.tree());
  budget.require(all.activeVoxelCount() / 512 * sizeof(openvdb::Int32Tree::LeafNodeType::Buffer),
                 "the part grid", kScatteredAdvice);
  all.voxelizeActiveTiles();
  budget.take(bytesOfFloats(all), "the part grid", kScatteredAdvice);
  const auto labels = std::make_shared<openvdb::Int32Tree>(all, 0, 0, openvdb::TopologyCopy());
  const FootSurfaces feet = footSurfaces(surfaces);
  const FootOwners owners(feet);
  visitFeet(feet, mask.tree(), kReachOfCrossed, budget, progress, 1,
            [&](const FootBins& /*bins*/, const openvdb::Coord& origin, const LeafFeet& found) {
              auto* const leaf = labels->probeLeaf(origin);
              if (leaf == nullptr) return;
              found.forEachFound([&](unsigned i) {
                if (!leaf->isValueOn(i)) return;
                const std::size_t s = owners.surfaceOf(found.place[i]);
                const Index face =
                    surfaces[s].base.adjacency.cornerFace[owners.cornerOf(s, found.place[i])];
                leaf->setValueOnly(i, surfaces[s].partOfFace[face]);
              });
            });
  if (voxels != nullptr) spreadLabels(*labels, progress);
  auto grid = openvdb::Int32Grid::create(labels);
  grid->setTransform(mask.transform().copy());
  grid->insertMeta(kPartNamesMetadata,
                   openvdb::StringMetadata(partNamesText({names.begin(), names.end()})));
  return grid;
}

}  // namespace vox
