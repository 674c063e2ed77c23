// The union of the grids of files from any program.

#include "libvox/io/unite_grids.h"

#include "libvox/core/error.h"
#include "libvox/core/memory.h"
#include "libvox/grid/openvdb.h"

#include <openvdb/tools/Composite.h>

#include <algorithm>
#include <string>
#include <utility>

namespace vox {
namespace {

/// Removes what the other one has not, or has with another value.
void keepSameMetadata(openvdb::MetaMap& metadata, const openvdb::MetaMap& other) {
  std::vector<std::string> differing;
  for (auto item = metadata.beginMeta(); item != metadata.endMeta(); ++item)
    if (const auto value = other[item->first]; !value || !(*value == *item->second))
      differing.push_back(item->first);
  for (const std::string& key : differing) metadata.removeMeta(key);
}

/// What keeps two grids from being united, and what to do about it; empty if nothing does.
std::string differenceOf(const openvdb::GridBase& a, const openvdb::GridBase& b) {
  if (a.type() != b.type())
    return "another type (" + b.type() + ", not " + a.type() + "); rename one";
  if (a.getGridClass() != b.getGridClass())
    return "another class (" + openvdb::GridBase::gridClassToString(b.getGridClass()) + ", not " +
           openvdb::GridBase::gridClassToString(a.getGridClass()) + "); rename one";
  if (a.transform() != b.transform())
    return "another transform; convert one with --like of the other";
  return {};
}

/// @return  false if there is no union of grids of this type, or the backgrounds differ
bool unite(openvdb::GridBase& to, openvdb::GridBase& from) {
  if (to.isType<openvdb::MaskGrid>()) {
    auto& mask = static_cast<openvdb::MaskGrid&>(to);
    mask.tree().topologyUnion(static_cast<openvdb::MaskGrid&>(from).tree());
    return true;
  }
  if (!to.isType<openvdb::FloatGrid>()) return false;
  auto& a = static_cast<openvdb::FloatGrid&>(to);
  auto& b = static_cast<openvdb::FloatGrid&>(from);
  if (a.background() != b.background()) return false;
  if (a.getGridClass() == openvdb::GRID_LEVEL_SET)
    openvdb::tools::csgUnion(a, b);
  else
    openvdb::tools::compMax(a, b);
  return true;
}

/// Puts grids into the order of the index. Grids of one name are in their order already.
void sortAs(const VdbIndex& index, std::vector<NamedGrid>& grids) {
  auto sorted = grids.begin();
  for (const VdbIndexGrid& entry : index.grids) {
    const auto grid = std::find_if(sorted, grids.end(), [&](const NamedGrid& one) {
      return one.grid->getName() == entry.head->getName();
    });
    if (grid != grids.end()) std::rotate(sorted++, grid, grid + 1);
  }
}

class Union {
 public:
  explicit Union(std::uint64_t maxMemory) : budget_(maxMemory) {}

  void add(const VdbIndex& index) {
    VdbFile read = readVdb(index.file);
    sortAs(index, read.grids);
    for (const NamedGrid& grid : read.grids) add(grid, index.file);
    if (metadata_ == nullptr)
      metadata_ = std::make_shared<openvdb::MetaMap>(*read.metadata);
    else
      keepSameMetadata(*metadata_, *read.metadata);
  }

  VdbFile result() const { return {grids_, metadata_}; }

 private:
  void add(const NamedGrid& grid, const std::filesystem::path& file) {
    budget_.take(grid.grid->memUsage(), "the grid " + grid.name, "merge fewer files at a time");
    const auto there = std::find_if(grids_.begin(), grids_.end(), [&](const NamedGrid& other) {
      return other.name == grid.name;
    });
    if (there == grids_.end()) {
      grids_.push_back(grid);
      firstFiles_.push_back(file);
      return;
    }
    openvdb::GridBase& to = *there->grid;
    const std::string first =
        firstFiles_[static_cast<std::size_t>(there - grids_.begin())].string();
    const std::string start = file.string() + ": the grid " + grid.name;
    if (const std::string difference = differenceOf(to, *grid.grid); !difference.empty())
      throw InputError(start + " is also in " + first + " and has " + difference);
    if (!unite(to, *grid.grid))
      throw InputError(start + " is also in " + first +
                       ": only masks, and floats of one background, can be united; rename one");
    keepSameMetadata(to, *grid.grid);
    to.removeMeta("vox_active_voxels");
  }

  MemoryBudget budget_;
  std::vector<NamedGrid> grids_;
  std::vector<std::filesystem::path> firstFiles_;  // of the grids
  std::shared_ptr<openvdb::MetaMap> metadata_;
};

}  // namespace

VdbFile unitedGrids(std::span<const VdbIndex> files, std::uint64_t maxMemory) {
  Union all(maxMemory);
  for (const VdbIndex& file : files) all.add(file);
  return all.result();
}

}  // namespace vox
