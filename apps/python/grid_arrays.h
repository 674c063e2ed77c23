#pragma once

#include "libvox/grid/openvdb_fwd.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace vox::python {

/// What a grid stores at a voxel, in the terms of NumPy.
struct ValueType {
  std::string name;        ///< "float32"
  std::size_t bytes;       ///< of a component
  std::size_t components;  ///< 1 or 3
};

/// @throws InputError  the grid has values that NumPy cannot hold
ValueType valueTypeOf(const openvdb::GridBase& grid);

// Active voxels in an order that depends on the grid only: those of leaf nodes, in the order of the
// tree, then those of tiles. Work is done in parallel.

/// @param coords  room for 3 numbers for each active voxel
void gatherCoords(const openvdb::GridBase& grid, std::int32_t* coords);

/// @param values  room for a value of valueTypeOf() for each active voxel
void gatherValues(const openvdb::GridBase& grid, void* values);

/// The lowest and the highest voxel of a box, index space, both inclusive.
struct VoxelBox {
  std::array<std::int32_t, 3> low, high;

  /// Number of voxels along an axis.
  std::int64_t side(std::size_t axis) const { return std::int64_t{high[axis]} - low[axis] + 1; }
};

/// The box of the active voxels; nothing if there are none.
std::optional<VoxelBox> activeBox(const openvdb::GridBase& grid);

/// The values of all voxels of a box, active or not; z runs fastest, then y.
/// @param values  room for a value of valueTypeOf() for each voxel
void fillDense(const openvdb::GridBase& grid, const VoxelBox& box, void* values);

}  // namespace vox::python
