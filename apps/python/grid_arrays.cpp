// The voxels of a grid as arrays.

#include "apps/python/grid_arrays.h"

#include "libvox/core/error.h"
#include "libvox/core/parallel.h"
#include "libvox/grid/openvdb.h"

#include <openvdb/tools/Dense.h>

#include <type_traits>
#include <vector>

namespace vox::python {
namespace {

using openvdb::Coord;
using openvdb::CoordBBox;

using ArrayTypes = openvdb::TypeList<openvdb::FloatGrid, openvdb::DoubleGrid, openvdb::Int32Grid,
                                     openvdb::Int64Grid, openvdb::Vec3IGrid, openvdb::Vec3SGrid,
                                     openvdb::Vec3DGrid, openvdb::BoolGrid, openvdb::MaskGrid>;

template <class Work>
void withType(const openvdb::GridBase& grid, Work&& work) {
  if (!grid.apply<ArrayTypes>(work))
    throw InputError("grid " + grid.getName() + ": has values of type " + grid.valueType() +
                     ", of which there are no arrays");
}

template <class Component>
const char* nameOf() {
  if constexpr (std::is_same_v<Component, bool>) return "bool";
  if constexpr (std::is_same_v<Component, float>) return "float32";
  if constexpr (std::is_same_v<Component, double>) return "float64";
  if constexpr (std::is_same_v<Component, std::int32_t>) return "int32";
  if constexpr (std::is_same_v<Component, std::int64_t>) return "int64";
}

/// Active voxels that have one value.
template <class Tree>
struct Tile {
  CoordBBox box;
  typename Tree::ValueType value;
};

/// Where the active voxels of a tree are, and the place of the first of each node in the arrays.
template <class Tree>
struct ActiveNodes {
  std::vector<const typename Tree::LeafNodeType*> leaves;
  std::vector<Tile<Tree>> tiles;
  std::vector<std::uint64_t> firsts;

  explicit ActiveNodes(const Tree& tree) {
    tree.getNodes(leaves);
    auto tile = tree.cbeginValueOn();
    tile.setMaxDepth(Tree::ValueOnCIter::LEAF_DEPTH - 1);
    for (; tile; ++tile) tiles.push_back({tile.getBoundingBox(), *tile});
    firsts.reserve(leaves.size() + tiles.size());
    std::uint64_t count = 0;
    for (const auto* leaf : leaves) {
      firsts.push_back(count);
      count += leaf->onVoxelCount();
    }
    for (const auto& one : tiles) {
      firsts.push_back(count);
      count += one.box.volume();
    }
  }

  /// Calls put(place, voxel, value) for all active voxels, in parallel.
  template <class Put>
  void forEach(Put&& put) const {
    constexpr std::size_t kLeavesPerTask = 64;
    parallelForEach(leaves.size(), kLeavesPerTask, [&](std::size_t i) {
      std::uint64_t place = firsts[i];
      for (auto voxel = leaves[i]->cbeginValueOn(); voxel; ++voxel)
        put(place++, voxel.getCoord(), typename Tree::ValueType(*voxel));
    });
    parallelForEach(tiles.size(), 1, [&](std::size_t i) {
      std::uint64_t place = firsts[leaves.size() + i];
      for (auto voxel = tiles[i].box.begin(); voxel; ++voxel) put(place++, *voxel, tiles[i].value);
    });
  }
};

CoordBBox boxOf(const VoxelBox& box) {
  return {Coord(box.low.data()), Coord(box.high.data())};
}

}  // namespace

ValueType valueTypeOf(const openvdb::GridBase& grid) {
  ValueType type;
  withType(grid, [&](const auto& typed) {
    using Value = typename std::decay_t<decltype(typed)>::ValueType;
    using Traits = openvdb::VecTraits<Value>;
    using Component = typename Traits::ElementType;
    type = {nameOf<Component>(), sizeof(Component), std::size_t{Traits::Size}};
  });
  return type;
}

void gatherCoords(const openvdb::GridBase& grid, std::int32_t* coords) {
  withType(grid, [&](const auto& typed) {
    const ActiveNodes nodes(typed.tree());
    nodes.forEach([&](std::uint64_t place, const Coord& voxel, const auto&) {
      for (int axis = 0; axis < 3; ++axis)
        coords[3 * place + static_cast<std::uint64_t>(axis)] = voxel[axis];
    });
  });
}

void gatherValues(const openvdb::GridBase& grid, void* values) {
  withType(grid, [&](const auto& typed) {
    using Value = typename std::decay_t<decltype(typed)>::ValueType;
    auto* const typedValues = static_cast<Value*>(values);
    const ActiveNodes nodes(typed.tree());
    nodes.forEach(
        [&](std::uint64_t place, const Coord&, const Value& value) { typedValues[place] = value; });
  });
}

std::optional<VoxelBox> activeBox(const openvdb::GridBase& grid) {
  const CoordBBox box = grid.evalActiveVoxelBoundingBox();
  if (box.empty()) return std::nullopt;
  VoxelBox found{};
  for (int axis = 0; axis < 3; ++axis) {
    found.low[static_cast<std::size_t>(axis)] = box.min()[axis];
    found.high[static_cast<std::size_t>(axis)] = box.max()[axis];
  }
  return found;
}

void fillDense(const openvdb::GridBase& grid, const VoxelBox& box, void* values) {
  withType(grid, [&](const auto& typed) {
    using Value = typename std::decay_t<decltype(typed)>::ValueType;
    openvdb::tools::Dense<Value> dense(boxOf(box), static_cast<Value*>(values));
    openvdb::tools::copyToDense(typed, dense);
  });
}

}  // namespace vox::python
