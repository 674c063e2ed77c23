// Differences as grids, to look at.

#include "libvox/inspect/difference_grids.h"

#include "libvox/core/version.h"
#include "libvox/inspect/compared.h"
#include "libvox/inspect/compared_types.h"
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

openvdb::MaskGrid::Ptr surplusOf(const openvdb::GridBase& a, const openvdb::GridBase& b) {
  const openvdb::MaskTree::Ptr tree = topologyOf(a);
  tree->topologyDifference(*topologyOf(b));
  auto grid = openvdb::MaskGrid::create(tree);
  grid->setTransform(a.transform().copy());
  return grid;
}

openvdb::FloatGrid::Ptr valueDifference(const openvdb::GridBase& a, const openvdb::GridBase& b,
                                        const Tolerance& tolerance) {
  auto difference = openvdb::FloatGrid::create();
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

DifferenceGrids differenceGrids(const openvdb::GridBase& a, const openvdb::GridBase& b,
                                const DiffOptions& options) {
  DifferenceGrids difference{surplusOf(a, b), surplusOf(b, a), nullptr};
  difference.onlyB->setTransform(a.transform().copy());
  if (a.type() == b.type() && !a.isType<openvdb::MaskGrid>())
    difference.values = valueDifference(a, b, Tolerance(options));
  return difference;
}

void writeDifference(const std::filesystem::path& a, const std::filesystem::path& b,
                     const DiffOptions& options, const std::filesystem::path& file,
                     bool overwrite) {
  const VdbFile fileA = readVdb(a);
  const VdbFile fileB = readVdb(b);
  openvdb::GridPtrVec grids;
  forEachPair(fileA, fileB, options,
              [&](const std::string& name, const openvdb::GridBase::Ptr& gridA,
                  const openvdb::GridBase::Ptr& gridB) {
                if (!gridA || !gridB) return;
                const DifferenceGrids difference = differenceGrids(*gridA, *gridB, options);
                difference.onlyB->setTransform(gridB->transform().copy());
                const auto keep = [&](const openvdb::GridBase::Ptr& grid, const char* what) {
                  if (!grid) return;
                  grid->setName(name + what);
                  grids.push_back(grid);
                };
                keep(difference.onlyA, "_only_a");
                keep(difference.onlyB, "_only_b");
                keep(difference.values, "_difference");
              });
  openvdb::MetaMap metadata;
  metadata.insertMeta("creator", openvdb::StringMetadata(std::string("vox ") + version()));
  AtomicFile output(file, overwrite);
  writeVdb(output.stream(), grids, metadata);
  output.commit();
}

}  // namespace vox
