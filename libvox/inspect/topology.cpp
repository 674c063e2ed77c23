// The active voxels of grids of any type.

#include "libvox/inspect/topology.h"

#include "libvox/core/error.h"
#include "libvox/grid/openvdb.h"
#include "libvox/inspect/compared_types.h"

#include <memory>

namespace vox {

void refuseType(const openvdb::GridBase& grid) {
  throw InputError(grid.getName() + ": grids of type " + grid.type() + " cannot be looked into");
}

openvdb::MaskTree::Ptr topologyOf(const openvdb::GridBase& grid) {
  openvdb::MaskTree::Ptr mask;
  const auto copy = [&](const auto& typed) {
    mask = std::make_shared<openvdb::MaskTree>(typed.tree(), false, true, openvdb::TopologyCopy());
  };
  if (!grid.apply<ComparedTypes>(copy)) refuseType(grid);
  return mask;
}

}  // namespace vox
