// Differences as grids, to look at.

#include "libvox/core/version.h"
#include "libvox/grid/openvdb.h"
#include "libvox/inspect/compared.h"
#include "libvox/inspect/compared_types.h"
#include "libvox/inspect/diff.h"
#include "libvox/io/atomic_file.h"
#include "libvox/io/write_vdb.h"

namespace vox {
namespace {

using openvdb::Coord;
using openvdb::CoordBBox;

template <class Value>
class DifferenceMaker {
 public:
  DifferenceMaker(const Tolerance& tolerance, openvdb::FloatTree& tree)
      : tolerance_(tolerance), accessor_(tree), tree_(tree) {}

  template <class Leaf>
  void leaf(const Coord& origin, const Region<Leaf>& a, const Region<Leaf>& b) {
    const RegionValues<Leaf> valuesA(a);
    const RegionValues<Leaf> valuesB(b);
    const openvdb::util::NodeMask<3> both = activeVoxels(a) & activeVoxels(b);
    for (auto voxel = both.beginOn(); voxel; ++voxel) {
      const Difference difference =
          differenceOf<Value>(valuesA[voxel.pos()], valuesB[voxel.pos()], tolerance_);
      if (difference.counts)
        accessor_.setValueOn(origin + Leaf::offsetToLocalCoord(voxel.pos()),
                             static_cast<float>(difference.size));
    }
  }

  template <class Node>
  void constant(const CoordBBox& box, const Region<Node>& a, const Region<Node>& b) {
    const Difference difference = differenceOf(a.value, b.value, tolerance_);
    if (!a.active || !b.active || !difference.counts) return;
    accessor_.clear();  // filling may put a tile where it points
    tree_.fill(box, static_cast<float>(difference.size), true);
  }

 private:
  Tolerance tolerance_;
  openvdb::tree::ValueAccessor<openvdb::FloatTree> accessor_;
  openvdb::FloatTree& tree_;
};

openvdb::GridBase::Ptr surplusOf(const openvdb::GridBase& a, const openvdb::GridBase& b,
                                 const std::string& name) {
  const openvdb::MaskTree::Ptr tree = topologyOf(a);
  tree->topologyDifference(*topologyOf(b));
  auto grid = openvdb::MaskGrid::create(tree);
  grid->setName(name);
  grid->setTransform(a.transform().copy());
  return grid;
}

openvdb::GridBase::Ptr differenceGrid(const openvdb::GridBase& a, const openvdb::GridBase& b,
                                      const Tolerance& tolerance, const std::string& name) {
  auto difference = openvdb::FloatGrid::create();
  difference->setName(name);
  difference->setTransform(a.transform().copy());
  a.apply<ComparedTypes>([&](const auto& typedA) {
    using Tree = typename std::decay_t<decltype(typedA)>::TreeType;
    const auto& typedB = static_cast<const std::decay_t<decltype(typedA)>&>(b);
    const TreePair<Tree> pair(typedA.tree(), typedB.tree());
    DifferenceMaker<typename Tree::ValueType> maker(tolerance, difference->tree());
    for (std::size_t i = 0; i < pair.partCount(); ++i) pair.visitPart(i, maker);
  });
  return difference;
}

}  // namespace

void writeDifference(const std::filesystem::path& a, const std::filesystem::path& b,
                     const DiffOptions& options, const std::filesystem::path& file,
                     bool overwrite) {
  const VdbFile fileA = readVdb(a);
  const VdbFile fileB = readVdb(b);
  const Tolerance tolerance(options);
  openvdb::GridPtrVec grids;
  forEachPair(fileA, fileB, options,
              [&](const std::string& name, const openvdb::GridBase::Ptr& gridA,
                  const openvdb::GridBase::Ptr& gridB) {
                if (!gridA || !gridB) return;
                grids.push_back(surplusOf(*gridA, *gridB, name + "_only_a"));
                grids.push_back(surplusOf(*gridB, *gridA, name + "_only_b"));
                if (gridA->type() == gridB->type() && !gridA->isType<openvdb::MaskGrid>())
                  grids.push_back(differenceGrid(*gridA, *gridB, tolerance, name + "_difference"));
              });
  openvdb::MetaMap metadata;
  metadata.insertMeta("creator", openvdb::StringMetadata(std::string("vox ") + version()));
  AtomicFile output(file, overwrite);
  writeVdb(output.stream(), grids, metadata);
  output.commit();
}

}  // namespace vox
