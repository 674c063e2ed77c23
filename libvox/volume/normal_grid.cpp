// From sums of vectors to unit normals.

#include "libvox/volume/normal_grid.h"

#include "libvox/core/parallel.h"

#include <openvdb/tree/LeafManager.h>

namespace vox {
namespace {

/// Sum of the neighbours of a voxel.
Vec3d sumAround(const VoxelSums& sums, const openvdb::Coord& voxel) {
  Vec3d sum = Vec3d::Zero();
  for (int step = 0; step < 27; ++step) {
    const openvdb::Coord next = voxel.offsetBy(step / 9 - 1, step / 3 % 3 - 1, step % 3 - 1);
    const VoxelSums::Place place = sums.placeOf({next.x() & ~7, next.y() & ~7, next.z() & ~7});
    if (place.leaf == nullptr || !place.leaf->isValueOn(next)) continue;
    sum += sums.sum(place, VoxelSums::Leaf::coordToOffset(next));
  }
  return sum;
}

}  // namespace

openvdb::Vec3SGrid::Ptr normalGrid(const openvdb::MaskGrid& mask, const VoxelSums& sums) {
  const openvdb::Vec3s zero(0, 0, 0);
  auto tree =
      std::make_shared<openvdb::Vec3STree>(mask.tree(), zero, zero, openvdb::TopologyCopy());
  openvdb::tree::LeafManager<openvdb::Vec3STree> leaves(*tree);
  constexpr std::size_t kLeavesPerTask = 64;
  forEach(leaves.leafCount(), kLeavesPerTask, [&](std::size_t i) {
    auto& leaf = leaves.leaf(i);
    const VoxelSums::Place place = sums.placeOf(leaf.origin());
    for (auto voxel = leaf.beginValueOn(); voxel; ++voxel) {
      Vec3d sum = sums.sum(place, voxel.pos());
      if (sum.isZero(0)) sum = sumAround(sums, voxel.getCoord());
      if (sum.isZero(0)) continue;
      sum.normalize();
      voxel.setValue(openvdb::Vec3s(static_cast<float>(sum.x()), static_cast<float>(sum.y()),
                                    static_cast<float>(sum.z())));
    }
  });
  auto grid = openvdb::Vec3SGrid::create(tree);
  grid->setTransform(mask.transform().copy());
  grid->setName("normal");
  grid->setVectorType(openvdb::VEC_COVARIANT_NORMALIZE);
  return grid;
}

}  // namespace vox
