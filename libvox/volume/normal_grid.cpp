// From means of vectors to unit normals.

#include "libvox/volume/normal_grid.h"

#include "libvox/core/parallel.h"

#include <openvdb/tree/LeafManager.h>

namespace vox {
openvdb::Vec3SGrid::Ptr normalGrid(const openvdb::MaskGrid& mask, const VoxelMeans& means) {
  const openvdb::Vec3s zero(0, 0, 0);
  auto tree =
      std::make_shared<openvdb::Vec3STree>(mask.tree(), zero, zero, openvdb::TopologyCopy());
  openvdb::tree::LeafManager<openvdb::Vec3STree> leaves(*tree);
  constexpr std::size_t kLeavesPerTask = 64;
  forEach(leaves.leafCount(), kLeavesPerTask, [&](std::size_t i) {
    auto& leaf = leaves.leaf(i);
    for (auto voxel = leaf.beginValueOn(); voxel; ++voxel) {
      const Vec3d normal = means.meanOf(voxel.getCoord()).value_or(Vec3d::Zero()).normalized();
      voxel.setValue(openvdb::Vec3s(static_cast<float>(normal.x()), static_cast<float>(normal.y()),
                                    static_cast<float>(normal.z())));
    }
  });
  auto grid = openvdb::Vec3SGrid::create(tree);
  grid->setTransform(mask.transform().copy());
  grid->setName("normal");
  grid->setVectorType(openvdb::VEC_COVARIANT_NORMALIZE);
  return grid;
}

}  // namespace vox
