// The part of each voxel, and a density as one grid for each part.

#include "libvox/pipeline/part_grid.h"

#include "libvox/core/memory.h"
#include "libvox/core/progress.h"
#include "libvox/pipeline/feet.h"
#include "libvox/pipeline/grids.h"
#include "libvox/pipeline/parts.h"
#include "libvox/volume/split_density.h"
#include "libvox/volume/spread_labels.h"

#include <openvdb/tools/Prune.h>

#include <cstdint>

namespace vox {
namespace {

using LabelLeaf = openvdb::Int32Tree::LeafNodeType;

/// Bytes of the labels of a solid whose tiles become voxels, and of spreading them.
std::uint64_t bytesOfSolidLabels(const openvdb::FloatTree& solid, const openvdb::MaskTree& near) {
  const std::uint64_t leaves =
      solid.leafCount() + solid.activeTileCount() +  // of which some are larger
      (solid.activeVoxelCount() - solid.activeLeafVoxelCount()) / LabelLeaf::SIZE;
  return leaves * (sizeof(LabelLeaf) + LabelLeaf::SIZE * sizeof(openvdb::Int32)) +
         bytesOfSpreading(leaves, near.activeVoxelCount());
}

void labelByFeet(openvdb::Int32Tree& labels, const openvdb::MaskTree& near, float reach,
                 std::span<const PreparedSurface> surfaces, const MemoryBudget& budget,
                 Progress& progress, double part) {
  const FootSurfaces feet = footSurfaces(surfaces);
  visitFeet(feet, near, reach, budget, progress, part,
            [&](const FootBins&, const openvdb::Coord& origin, const LeafFeet& found) {
              auto* const leaf = labels.probeLeaf(origin);
              found.forEachFound([&](unsigned i) {
                const FootSurfaces::Owner owner = feet.ownerOf(*found.place[i].cell);
                const PreparedSurface& surface = surfaces[owner.surface];
                leaf->buffer().data()[i] =
                    surface.partOfFace[surface.base.adjacency.cornerFace[owner.corner]];
              });
            });
}

}  // namespace

openvdb::Int32Grid::Ptr makePartGrid(const openvdb::MaskGrid& near, float reach,
                                     const openvdb::FloatTree* solid,
                                     std::span<const PreparedSurface> surfaces, std::size_t count,
                                     MemoryBudget& budget, Progress& progress) {
  constexpr openvdb::Int32 kNoPart = 0;
  constexpr openvdb::Int32 kFirst = 1;
  const openvdb::Int32 atFirst = count == 1 ? kFirst : kNoPart;
  budget.take(bytesOfFloats(near.tree()), "the part grid", kScatteredAdvice);
  if (solid != nullptr && count > 1)
    budget.take(bytesOfSolidLabels(*solid, near.tree()), "the parts of the inside",
                "use --fill surface or larger voxels, or raise --max-memory");
  const auto labels = solid == nullptr ? std::make_shared<openvdb::Int32Tree>(
                                             near.tree(), kNoPart, atFirst, openvdb::TopologyCopy())
                                       : std::make_shared<openvdb::Int32Tree>(
                                             *solid, kNoPart, atFirst, openvdb::TopologyCopy());
  if (count > 1) {
    if (solid != nullptr) labels->voxelizeActiveTiles();
    labelByFeet(*labels, near.tree(), reach, surfaces, budget, progress, solid ? 0.5 : 1);
    if (solid != nullptr) spreadLabels(*labels, progress);
    for (auto leaf = labels->beginLeaf(); leaf; ++leaf)
      for (auto voxel = leaf->beginValueOn(); voxel; ++voxel)
        if (*voxel == kNoPart) voxel.setValue(kFirst);
    if (solid != nullptr) openvdb::tools::prune(*labels);
  }
  auto grid = openvdb::Int32Grid::create(labels);
  grid->setTransform(near.transform().copy());
  return grid;
}

std::vector<openvdb::FloatGrid::Ptr> splitByParts(const openvdb::FloatGrid& density,
                                                  const openvdb::Int32Tree& parts,
                                                  const std::vector<std::string>& names,
                                                  MemoryBudget& budget,
                                                  std::vector<std::string>& warnings) {
  budget.take(bytesOfSplitting(density.tree(), parts, names.size()), "a grid for each part",
              "leave out --split and use the grid part, or raise --max-memory");
  const std::vector<openvdb::FloatTree::Ptr> trees =
      splitDensity(density.tree(), parts, names.size());
  const std::vector<std::string> gridNames = gridNamesOfParts(names);
  std::vector<openvdb::FloatGrid::Ptr> grids;
  std::string firstEmpty;
  std::size_t empty = 0;
  for (std::size_t i = 0; i < trees.size(); ++i) {
    if (!trees[i]) {
      if (empty++ == 0) firstEmpty = names[i];
      continue;
    }
    const auto grid = openvdb::FloatGrid::create(trees[i]);
    grid->insertMeta(density);
    grid->setTransform(density.transform().copy());
    grid->setName(gridNames[i]);
    grid->insertMeta(kPartNameMetadata, openvdb::StringMetadata(textOfName(names[i])));
    grids.push_back(grid);
  }
  if (empty > 0)
    warnings.push_back(std::to_string(empty) +
                       (empty == 1 ? " part has no voxels and no grid: "
                                   : " parts have no voxels and no grids; the first is ") +
                       textOfName(firstEmpty));
  return grids;
}

}  // namespace vox
