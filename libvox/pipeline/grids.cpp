// What becomes of the voxels: the grids asked for, and what they need.

#include "libvox/pipeline/grids.h"

#include "libvox/mesh/adjacency.h"
#include "libvox/pipeline/distance.h"
#include "libvox/pipeline/inside.h"
#include "libvox/pipeline/work.h"
#include "libvox/volume/density.h"
#include "libvox/volume/fill.h"

#include <openvdb/openvdb.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <sstream>

namespace vox {
namespace {

/// Bytes of a tree of floats with the nodes of a mask.
std::uint64_t bytesOfDensity(const openvdb::MaskTree& mask) {
  using Leaf = openvdb::FloatTree::LeafNodeType;
  using Upper = openvdb::FloatTree::RootNodeType::ChildNodeType;
  using Lower = Upper::ChildNodeType;
  const auto nodes = mask.nodeCount();  // leaves first, root last
  return nodes[0] * (sizeof(Leaf) + Leaf::SIZE * sizeof(float)) + nodes[1] * sizeof(Lower) +
         nodes[2] * sizeof(Upper);
}

/// Bytes of nodes per square voxel of a surface: 1.5 leaves per 64 and 1.5 inner nodes per 16384,
/// averaged over directions.
template <class TreeT>
double bytesPerArea(double valueBytes) {
  using Leaf = typename TreeT::LeafNodeType;
  using Lower = typename TreeT::RootNodeType::ChildNodeType::ChildNodeType;
  return 1.5 * ((sizeof(Leaf) + Leaf::SIZE * valueBytes) / 64 + sizeof(Lower) / 16384.0);
}

double bytesOfGrids(double area, std::span<const GridKind> kinds) {
  double perArea = bytesPerArea<openvdb::MaskTree>(0);
  for (const GridKind kind : kinds)
    if (kind == GridKind::kDensity) perArea += bytesPerArea<openvdb::FloatTree>(sizeof(float));
  return area * perArea;
}

}  // namespace

double workOfGrids(std::span<const double> areas, std::span<const GridKind> kinds) {
  const double area = std::accumulate(areas.begin(), areas.end(), 0.0);
  double work = 0;
  for (const GridKind kind : kinds)
    if (kind == GridKind::kDensity) work += workOfDensity(area);
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
                                const Progress& progress) {
  progress.check();
  if (kind == GridKind::kMask) return mask;
  if (kind == GridKind::kSurface)
    return surfaceGrid(surfaces, volume, mask->transform(), budget, progress);
  openvdb::MaskTree::Ptr voxels = mask->treePtr();
  if (volume.fill.value_or(Fill::kSurface) == Fill::kSolid) {
    budget.require(bytesOfFilling(*voxels), "the inside", kScatteredAdvice);
    voxels = solidOf(*voxels, surfaces, budget, progress);
  }
  budget.take(bytesOfDensity(*voxels), "the density grid", kScatteredAdvice);
  const auto density = densityGrid(*voxels, static_cast<float>(volume.gain.value_or(1)));
  density->setTransform(mask->transform().copy());
  return density;
}

std::uint64_t expectedBytes(std::span<const openvdb::GridBase::Ptr> grids) {
  constexpr std::uint64_t kPerLeaf = 145;
  constexpr std::uint64_t kPerLeafOfValues = 195;
  std::uint64_t bytes = 0;
  for (const auto& grid : grids)
    bytes += grid->constBaseTree().leafCount() *
             (grid->isType<openvdb::MaskGrid>() ? kPerLeaf : kPerLeafOfValues);
  return bytes;
}

}  // namespace vox
