// Grids of vectors on the active voxels of a mask.

#include "libvox/volume/vector_grid.h"

#include "libvox/core/parallel.h"
#include "libvox/grid/openvdb.h"

#include <memory>
#include <vector>

namespace vox {
namespace {

using MaskPage = openvdb::MaskTree::RootNodeType::ChildNodeType::ChildNodeType;
using VectorUpper = openvdb::Vec3STree::RootNodeType::ChildNodeType;
using VectorPage = VectorUpper::ChildNodeType;
using VectorLeaf = VectorPage::ChildNodeType;

const openvdb::Vec3s kZero(0, 0, 0);

std::unique_ptr<VectorLeaf> leafOf(const MaskPage::ChildNodeType& mask, float value) {
  auto leaf = std::make_unique<VectorLeaf>(openvdb::PartialCreate(), mask.origin(), kZero);
  leaf->setValueMask(mask.valueMask());
  leaf->allocate();
  openvdb::Vec3s* const values = leaf->buffer().data();
  for (openvdb::Index i = 0; i < VectorLeaf::SIZE; ++i)
    values[i] = mask.isValueOn(i) ? openvdb::Vec3s(value) : kZero;
  return leaf;
}

std::unique_ptr<VectorPage> pageOf(const MaskPage& mask, float value) {
  auto page = std::make_unique<VectorPage>(mask.origin(), kZero);
  for (auto leaf = mask.cbeginChildOn(); leaf; ++leaf)
    page->addLeaf(leafOf(*leaf, value).release());
  return page;
}

}  // namespace

openvdb::Vec3SGrid::Ptr vectorGrid(const openvdb::MaskGrid& mask, float value) {
  std::vector<const MaskPage*> maskPages;
  mask.tree().getNodes(maskPages);
  std::vector<std::unique_ptr<VectorPage>> pages(maskPages.size());
  parallelForEach(pages.size(), 1, [&](std::size_t i) { pages[i] = pageOf(*maskPages[i], value); });

  auto tree = std::make_shared<openvdb::Vec3STree>(kZero);
  for (auto& page : pages) {
    const openvdb::Coord origin = page->origin();
    if (tree->probeNode<VectorUpper>(origin) == nullptr)
      tree->root().addChild(new VectorUpper(origin, kZero));
    tree->probeNode<VectorUpper>(origin)->addChild(page.release());
  }
  auto grid = openvdb::Vec3SGrid::create(tree);
  grid->setTransform(mask.transform().copy());
  return grid;
}

}  // namespace vox
