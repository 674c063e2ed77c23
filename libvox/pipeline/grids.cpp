// What becomes of the voxels: the grids asked for, and what they need.

#include "libvox/pipeline/grids.h"

#include "libvox/mesh/adjacency.h"
#include "libvox/pipeline/distance.h"
#include "libvox/pipeline/inside.h"
#include "libvox/pipeline/normals.h"
#include "libvox/pipeline/work.h"
#include "libvox/volume/density.h"
#include "libvox/volume/fill.h"
#include "libvox/volume/normal_grid.h"

#include <openvdb/openvdb.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>

namespace vox {
namespace {

/// Bytes of nodes per square voxel of a surface: 1.5 leaves per 64 and 1.5 inner nodes per 16384,
/// averaged over directions.
template <class TreeT>
double bytesPerArea(std::size_t valueBytes) {
  using Leaf = typename TreeT::LeafNodeType;
  using Lower = typename TreeT::RootNodeType::ChildNodeType::ChildNodeType;
  const auto leafBytes = static_cast<double>(sizeof(Leaf) + Leaf::SIZE * valueBytes);
  return 1.5 * (leafBytes / 64 + sizeof(Lower) / 16384.0);
}

double bytesOfGrids(double area, std::span<const GridKind> kinds) {
  double perArea = bytesPerArea<openvdb::MaskTree>(0);
  for (const GridKind kind : kinds) {
    if (kind == GridKind::kDensity) perArea += bytesPerArea<openvdb::FloatTree>(sizeof(float));
    if (kind == GridKind::kNormal)
      perArea += bytesPerArea<openvdb::Vec3STree>(sizeof(openvdb::Vec3s));
    if (kind == GridKind::kColor)
      perArea += bytesPerArea<openvdb::Vec3STree>(sizeof(openvdb::Vec3f));
  }
  return area * perArea;
}

openvdb::GridBase::Ptr makeDensity(const openvdb::MaskGrid& mask,
                                   std::span<const PreparedSurface> surfaces,
                                   const VolumeOptions& volume, MemoryBudget& budget,
                                   const Progress& progress) {
  openvdb::MaskTree::ConstPtr solid;
  const openvdb::MaskTree* tree = &mask.tree();
  if (volume.fill.value_or(Fill::kSurface) == Fill::kSolid) {
    budget.require(bytesOfFilling(*tree), "the inside", kScatteredAdvice);
    solid = solidOf(*tree, surfaces, budget, progress);
    tree = solid.get();
  }
  budget.take(bytesOfGrid<openvdb::FloatTree>(*tree), "the density grid", kScatteredAdvice);
  auto density = densityGrid(*tree, static_cast<float>(volume.gain.value_or(1)));
  density->setTransform(mask.transform().copy());
  return density;
}

openvdb::GridBase::Ptr makeNormals(const openvdb::MaskGrid& mask,
                                   std::span<const PreparedSurface> surfaces, MemoryBudget& budget,
                                   Progress& progress) {
  constexpr const char* kAdvice = "leave it out, use larger voxels, or raise --max-memory";
  budget.take(bytesOfGrid<openvdb::Vec3STree>(mask.tree()), "the normal grid", kAdvice);
  budget.require(VoxelMeans::bytesFor(mask.tree()), "the normals", kAdvice);
  VoxelMeans means(mask.tree());
  for (const PreparedSurface& surface : surfaces)
    addNormals(surface.base, surface.way, progress, means);
  means.fillGaps();
  return normalGrid(mask, means);
}

}  // namespace

double workOfGrids(std::span<const double> areas, std::span<const GridKind> kinds) {
  const double area = std::accumulate(areas.begin(), areas.end(), 0.0);
  double work = 0;
  for (const GridKind kind : kinds) {
    if (kind == GridKind::kDensity) work += workOfDensity(area);
    if (kind == GridKind::kNormal) work += workOfNormals(area);
    if (kind == GridKind::kColor) work += workOfColor(area);
  }
  return work;
}

void requireGridsFit(const SubdivisionLevel& base, std::span<const GridKind> kinds,
                     const GridTransform& transform, double longestSide,
                     const MemoryBudget& budget) {
  const auto& twin = base.adjacency.twin;
  const bool open = std::find(twin.begin(), twin.end(), kNone) != twin.end();
  if (open && base.boundary == BoundaryStage::kPlain) return;
  const double bytes = bytesOfGrids(areaOf(base.mesh), kinds);
  constexpr double kCertain = 4;
  const double left = static_cast<double>(budget.left());
  if (bytes <= kCertain * left) return;
  const double larger = std::sqrt(kCertain * bytes / left) * transform.voxelSize;
  std::ostringstream advice;
  advice.precision(3);
  advice << "use --dim " << static_cast<std::int64_t>(std::max(1.0, longestSide / larger))
         << " or --voxel-size " << larger << ", or raise --max-memory";
  constexpr double kMostBytes = 1e18;
  budget.require(static_cast<std::uint64_t>(std::min(bytes, kMostBytes)), "the grid", advice.str());
}

openvdb::GridBase::Ptr makeGrid(GridKind kind, const openvdb::MaskGrid::Ptr& mask,
                                std::span<const PreparedSurface> surfaces,
                                const VolumeOptions& volume, MemoryBudget& budget,
                                Progress& progress) {
  progress.check();
  switch (kind) {
    case GridKind::kMask:
      break;
    case GridKind::kDensity:
      return makeDensity(*mask, surfaces, volume, budget, progress);
    case GridKind::kSurface:
      return surfaceGrid(surfaces, volume, mask->transform(), budget, progress);
    case GridKind::kNormal:
      return makeNormals(*mask, surfaces, budget, progress);
    case GridKind::kColor:
      return makeColorGrid(*mask, surfaces, budget, progress);
  }
  return mask;
}

std::uint64_t expectedBytes(std::span<const openvdb::GridBase::Ptr> grids) {
  constexpr std::uint64_t kPerLeaf = 145;
  constexpr std::uint64_t kPerLeafOfValues = 195;
  constexpr std::uint64_t kPerLeafOfVectors = 800;
  std::uint64_t bytes = 0;
  for (const auto& grid : grids)
    bytes += grid->constBaseTree().leafCount() * (grid->isType<openvdb::MaskGrid>() ? kPerLeaf
                                                  : grid->isType<openvdb::Vec3SGrid>()
                                                      ? kPerLeafOfVectors
                                                      : kPerLeafOfValues);
  return bytes;
}

}  // namespace vox
