// The output grids, made from voxels and surfaces.

#include "libvox/pipeline/grids.h"

#include "libvox/core/memory.h"
#include "libvox/core/progress.h"
#include "libvox/grid/crop.h"
#include "libvox/grid/openvdb.h"
#include "libvox/pipeline/colors.h"
#include "libvox/pipeline/distance.h"
#include "libvox/pipeline/feet.h"
#include "libvox/pipeline/inside.h"
#include "libvox/pipeline/normals.h"
#include "libvox/pipeline/part_grid.h"
#include "libvox/pipeline/soft_density.h"
#include "libvox/volume/density.h"
#include "libvox/volume/fill.h"

#include <algorithm>

namespace vox {
namespace {

/// Bytes of a tree of values with the nodes of a mask.
template <class TreeT>
std::uint64_t bytesOfGrid(const openvdb::MaskTree& mask) {
  using Leaf = typename TreeT::LeafNodeType;
  using Upper = typename TreeT::RootNodeType::ChildNodeType;
  using Lower = typename Upper::ChildNodeType;
  const auto nodes = mask.nodeCount();  // leaves first, root last
  return nodes[0] * (sizeof(Leaf) + Leaf::SIZE * sizeof(typename TreeT::ValueType)) +
         nodes[1] * sizeof(Lower) + nodes[2] * sizeof(Upper);
}

openvdb::FloatGrid::Ptr hardDensityGrid(const openvdb::MaskTree& mask,
                                        std::span<const PreparedSurface> surfaces,
                                        const VolumeSettings& volume, const Region& region,
                                        float value, MemoryBudget& budget, Progress& progress,
                                        std::vector<std::string>& warnings) {
  openvdb::MaskTree::Ptr solid;
  const openvdb::MaskTree* tree = &mask;
  if (volume.fill == Fill::kSolid) {
    budget.require(bytesOfFilling(*tree), "the inside", kScatteredAdvice);
    solid = solidOf(*tree, surfaces, volume, budget, progress, warnings).voxels;
    crop(*solid, region);
    tree = solid.get();
  }
  budget.take(bytesOfFloats(*tree), "the density grid", kScatteredAdvice);
  return densityGrid(*tree, value);
}

openvdb::GridBase::Ptr makeDensity(const openvdb::MaskGrid& mask,
                                   std::span<const PreparedSurface> surfaces,
                                   const VolumeSettings& volume, const Region& region,
                                   MemoryBudget& budget, Progress& progress,
                                   std::vector<std::string>& warnings) {
  const auto value =
      static_cast<float>(densityValue(volume.gain, volume.target, mask.voxelSize()[0]));
  const auto density =
      volume.edge == Edge::kSoft
          ? softDensityGrid(mask.tree(), surfaces, volume, value, budget, progress, warnings)
          : hardDensityGrid(mask.tree(), surfaces, volume, region, value, budget, progress,
                            warnings);
  density->setTransform(mask.transform().copy());
  density->insertMeta(kGainMetadata, openvdb::FloatMetadata(value));
  return density;
}

}  // namespace

std::uint64_t bytesOfFloats(const openvdb::MaskTree& mask) {
  return bytesOfGrid<openvdb::FloatTree>(mask);
}

std::uint64_t bytesOfVectors(const openvdb::MaskTree& mask) {
  return bytesOfGrid<openvdb::Vec3STree>(mask);
}

bool needsVoxels(std::span<const GridKind> kinds) {
  return std::any_of(kinds.begin(), kinds.end(),
                     [](GridKind kind) { return kind != GridKind::kSurface; });
}

bool needsSurfaces(std::span<const GridKind> kinds, const VolumeSettings& volume) {
  return std::any_of(kinds.begin(), kinds.end(), [&](GridKind kind) {
    if (kind == GridKind::kDensity)
      return volume.edge == Edge::kSoft || volume.fill == Fill::kSolid;
    return kind != GridKind::kMask;
  });
}

bool needsInside(std::span<const GridKind> kinds, const VolumeSettings& volume) {
  return std::any_of(kinds.begin(), kinds.end(), [&](GridKind kind) {
    return kind == GridKind::kSurface ||
           ((kind == GridKind::kDensity || kind == GridKind::kPart) && volume.fill == Fill::kSolid);
  });
}

openvdb::GridBase::Ptr makeGrid(GridKind kind, const GridSources& sources,
                                const VolumeSettings& volume, MemoryBudget& budget,
                                Progress& progress, std::vector<std::string>& warnings) {
  progress.check();
  const auto& [mask, surfaces, markVoxels, soft, solid, partCount, region, bandOfPart] = sources;
  switch (kind) {
    case GridKind::kMask:
      break;
    case GridKind::kDensity:
      return makeDensity(*mask, surfaces, volume, region, budget, progress, warnings);
    case GridKind::kSurface:
      return surfaceGrid(surfaces, volume, mask->transform(), markVoxels, bandOfPart, budget,
                         progress, warnings);
    case GridKind::kNormal:
      return makeNormalGrid(soft ? *soft : *mask, surfaces, soft ? kReachOfSoft : kReachOfCrossed,
                            budget, progress);
    case GridKind::kColor:
      return makeColorGrid(*mask, soft.get(), surfaces, budget, progress);
    case GridKind::kPart:
      return makePartGrid(soft ? *soft : *mask, soft ? kReachOfSoft : kReachOfCrossed,
                          solid ? &solid->tree() : nullptr, surfaces, partCount, budget, progress);
  }
  return mask;
}

std::uint64_t expectedBytes(std::span<const openvdb::GridBase::Ptr> grids) {
  constexpr std::uint64_t kMask = 145;  // of a leaf
  constexpr std::uint64_t kFog = 195;
  constexpr std::uint64_t kDistances = 850;
  constexpr std::uint64_t kParts = 260;
  constexpr std::uint64_t kVectors = 800;
  std::uint64_t bytes = 0;
  for (const auto& grid : grids) {
    std::uint64_t perLeaf = kDistances;
    if (grid->isType<openvdb::MaskGrid>()) perLeaf = kMask;
    if (grid->isType<openvdb::Int32Grid>()) perLeaf = kParts;
    if (grid->isType<openvdb::Vec3SGrid>()) perLeaf = kVectors;
    if (grid->getGridClass() == openvdb::GRID_FOG_VOLUME) perLeaf = kFog;
    bytes += grid->constBaseTree().leafCount() * perLeaf;
  }
  return bytes;
}

}  // namespace vox
