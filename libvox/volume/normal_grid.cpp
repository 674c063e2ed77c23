// From means of vectors to unit normals.

#include "libvox/volume/normal_grid.h"

#include "libvox/core/parallel.h"

#include <openvdb/tree/LeafManager.h>

namespace vox {
namespace {

/// Of length 1, or 0.
openvdb::Vec3s directionOf(const VoxelMeans::Sum& sum) {
  const openvdb::Vec3d v(static_cast<double>(sum.x), static_cast<double>(sum.y),
                         static_cast<double>(sum.z));
  const double length = v.length();
  return length > 0 ? openvdb::Vec3s(v * (1 / length)) : openvdb::Vec3s(0);
}

}  // namespace

openvdb::Vec3SGrid::Ptr normalGrid(const openvdb::MaskGrid& mask, const VoxelMeans& means) {
  const openvdb::Vec3s zero(0, 0, 0);
  auto tree =
      std::make_shared<openvdb::Vec3STree>(mask.tree(), zero, zero, openvdb::TopologyCopy());
  openvdb::tree::LeafManager<openvdb::Vec3STree> leaves(*tree);
  constexpr std::size_t kLeavesPerTask = 64;
  forEach(leaves.leafCount(), kLeavesPerTask, [&](std::size_t i) {
    auto& leaf = leaves.leaf(i);
    const VoxelMeans::Sum* sum = means.sumsOf(leaf.origin());
    for (auto voxel = leaf.beginValueOn(); voxel; ++voxel) voxel.setValue(directionOf(*sum++));
  });
  auto grid = openvdb::Vec3SGrid::create(tree);
  grid->setTransform(mask.transform().copy());
  grid->setName("normal");
  grid->setVectorType(openvdb::VEC_COVARIANT_NORMALIZE);
  return grid;
}

}  // namespace vox
