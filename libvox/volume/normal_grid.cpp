// Unit normals from means of vectors.

#include "libvox/volume/normal_grid.h"

#include "libvox/core/parallel.h"
#include "libvox/grid/openvdb.h"
#include "libvox/grid/voxel_means.h"

#include <memory>
#include <vector>

namespace vox {
namespace {

using MaskPage = openvdb::MaskTree::RootNodeType::ChildNodeType::ChildNodeType;
using NormalUpper = openvdb::Vec3STree::RootNodeType::ChildNodeType;
using NormalPage = NormalUpper::ChildNodeType;
using NormalLeaf = NormalPage::ChildNodeType;

const openvdb::Vec3s kZero(0, 0, 0);

/// The direction of a sum, of length 1; 0 if the sum is 0.
openvdb::Vec3s directionOf(const VoxelMeans::Sum& sum) {
  const openvdb::Vec3d v(static_cast<double>(sum.x), static_cast<double>(sum.y),
                         static_cast<double>(sum.z));
  const double length = v.length();
  return length > 0 ? openvdb::Vec3s(v * (1 / length)) : kZero;
}

/// The leaf with the normals of the voxels of a leaf of the mask.
/// @param sum  of the first active voxel; those of the other active voxels follow it
std::unique_ptr<NormalLeaf> leafOf(const MaskPage::ChildNodeType& mask,
                                   const VoxelMeans::Sum* sum) {
  auto leaf = std::make_unique<NormalLeaf>(openvdb::PartialCreate(), mask.origin(), kZero);
  leaf->setValueMask(mask.valueMask());
  leaf->allocate();
  // A single pass over the memory of the leaf, because memory takes most of the time.
  openvdb::Vec3s* const values = leaf->buffer().data();
  for (openvdb::Index i = 0; i < NormalLeaf::SIZE; ++i)
    values[i] = mask.isValueOn(i) ? directionOf(*sum++) : kZero;
  return leaf;
}

std::unique_ptr<NormalPage> pageOf(const MaskPage& mask, const VoxelMeans& means) {
  auto page = std::make_unique<NormalPage>(mask.origin(), kZero);
  for (auto leaf = mask.cbeginChildOn(); leaf; ++leaf)
    page->addLeaf(leafOf(*leaf, means.sumsOf(leaf->origin())).release());
  return page;
}

}  // namespace

openvdb::Vec3SGrid::Ptr normalGrid(const openvdb::MaskGrid& mask, const VoxelMeans& means) {
  std::vector<const MaskPage*> maskPages;
  mask.tree().getNodes(maskPages);
  std::vector<std::unique_ptr<NormalPage>> pages(maskPages.size());
  parallelForEach(pages.size(), 1, [&](std::size_t i) { pages[i] = pageOf(*maskPages[i], means); });

  auto tree = std::make_shared<openvdb::Vec3STree>(kZero);
  for (auto& page : pages) {
    const openvdb::Coord origin = page->origin();
    if (tree->probeNode<NormalUpper>(origin) == nullptr)
      tree->root().addChild(new NormalUpper(origin, kZero));
    tree->probeNode<NormalUpper>(origin)->addChild(page.release());
  }
  auto grid = openvdb::Vec3SGrid::create(tree);
  grid->setTransform(mask.transform().copy());
  grid->setName("normal");
  grid->setVectorType(openvdb::VEC_COVARIANT_NORMALIZE);
  return grid;
}

}  // namespace vox
