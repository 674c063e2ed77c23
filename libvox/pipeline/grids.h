#pragma once

#include "libvox/core/memory.h"
#include "libvox/core/progress.h"
#include "libvox/grid/transform.h"
#include "libvox/options/grid_kind.h"
#include "libvox/options/volume_options.h"
#include "libvox/pipeline/choose.h"
#include "libvox/pipeline/colors.h"
#include "libvox/subdivide/level.h"

#include <openvdb/openvdb.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

namespace vox {

/// An object as it is voxelized, in index space.
struct PreparedSurface {
  std::string name;
  SubdivisionLevel base;
  ConversionWay way;
  std::optional<PlacedTexture> texture = {};
  openvdb::MaskTree::Ptr voxels = {};  ///< its own; null: there was no need to tell them apart
};

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

/// What to do about a grid that is too large.
inline constexpr const char* kScatteredAdvice =
    "the model is scattered over much space: use larger voxels, or raise --max-memory";

/// Whether a grid is made from black voxels.
bool needsVoxels(std::span<const GridKind> kinds);

/// The output grid of a kind, from the black voxels and the surfaces they came from.
/// @throws LimitError  it does not fit into the budget
/// @throws Cancelled
openvdb::GridBase::Ptr makeGrid(GridKind kind, const openvdb::MaskGrid::Ptr& mask,
                                std::span<const PreparedSurface> surfaces,
                                const VolumeOptions& volume, MemoryBudget& budget,
                                Progress& progress);

/// Work of making grids (work.h), by the area of each object in square voxels.
double workOfGrids(std::span<const double> areas, std::span<const GridKind> kinds);

/// Bytes of a file of these grids, as once measured.
std::uint64_t expectedBytes(std::span<const openvdb::GridBase::Ptr> grids);

}  // namespace vox
