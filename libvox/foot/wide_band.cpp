// Bands wider than what is computed exactly.

#include "libvox/foot/wide_band.h"

#include "libvox/core/parallel.h"
#include "libvox/grid/openvdb.h"

#include <openvdb/tools/ChangeBackground.h>
#include <openvdb/tools/FastSweeping.h>
#include <openvdb/tools/Prune.h>

#include <cmath>
#include <vector>

namespace vox {

openvdb::FloatTree::Ptr widened(const openvdb::FloatTree::Ptr& narrow, double from, double to,
                                double voxelSize) {
  auto grid = openvdb::FloatGrid::create(narrow);
  grid->setTransform(openvdb::math::Transform::createLinearTransform(voxelSize));
  grid->setGridClass(openvdb::GRID_LEVEL_SET);
  const int steps = static_cast<int>(std::ceil(to - from)) + 1;
  const auto wide = openvdb::tools::dilateSdf(*grid, steps, openvdb::tools::NN_FACE_EDGE_VERTEX);
  const auto limit = static_cast<float>(to * voxelSize);
  std::vector<openvdb::FloatTree::LeafNodeType*> leaves;
  wide->tree().getNodes(leaves);
  constexpr std::size_t kLeavesPerTask = 64;
  parallelForEach(leaves.size(), kLeavesPerTask, [&](std::size_t l) {
    for (auto value = leaves[l]->beginValueOn(); value; ++value)
      if (!(std::abs(*value) < limit)) value.setValueOff();
  });
  openvdb::tools::changeLevelSetBackground(wide->tree(), limit);
  openvdb::tools::pruneInactive(wide->tree());
  return wide->treePtr();
}

}  // namespace vox
