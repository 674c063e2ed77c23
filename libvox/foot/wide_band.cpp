// Bands wider than what is computed exactly.

#include "libvox/foot/wide_band.h"

#include "libvox/core/parallel.h"
#include "libvox/foot/band.h"
#include "libvox/grid/openvdb.h"

#include <openvdb/tools/ChangeBackground.h>
#include <openvdb/tools/FastSweeping.h>
#include <openvdb/tools/Prune.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace vox {

openvdb::FloatTree::Ptr widened(openvdb::FloatTree::Ptr narrow, const BandWidths& from,
                                const BandWidths& to, double voxelSize) {
  using Sweep = openvdb::tools::FastSweepingDomain;
  // Distances below the background are taken as they are.
  openvdb::tools::changeLevelSetBackground(*narrow,
                                           backgroundOf(std::max(from.in, from.out), voxelSize));
  auto grid = openvdb::FloatGrid::create(std::move(narrow));
  grid->setTransform(openvdb::math::Transform::createLinearTransform(voxelSize));
  grid->setGridClass(openvdb::GRID_LEVEL_SET);
  const double farther = std::max(to.in - from.in, to.out - from.out);
  const int steps = static_cast<int>(std::ceil(farther)) + 1;
  const Sweep sides = to.in <= from.in     ? Sweep::SWEEP_GREATER_THAN_ISOVALUE
                      : to.out <= from.out ? Sweep::SWEEP_LESS_THAN_ISOVALUE
                                           : Sweep::SWEEP_ALL;
  const auto wide =
      openvdb::tools::dilateSdf(*grid, steps, openvdb::tools::NN_FACE_EDGE_VERTEX, 1, sides);
  const float in = backgroundOf(to.in, voxelSize);
  const float out = backgroundOf(to.out, voxelSize);
  std::vector<openvdb::FloatTree::LeafNodeType*> leaves;
  wide->tree().getNodes(leaves);
  constexpr std::size_t kLeavesPerTask = 64;
  parallelForEach(leaves.size(), kLeavesPerTask, [&](std::size_t l) {
    for (auto value = leaves[l]->beginValueOn(); value; ++value)
      if (!(-in < *value && *value < out)) value.setValueOff();
  });
  openvdb::tools::changeAsymmetricLevelSetBackground(wide->tree(), out, -in);
  openvdb::tools::pruneInactive(wide->tree());
  return wide->treePtr();
}

}  // namespace vox
