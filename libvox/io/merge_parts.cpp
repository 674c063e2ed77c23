// Nodes of parts in one tree, and their packed values one after the other. OpenVDB's files list the
// values of a grid leaf by leaf in the order of the tree, and so does a sequence of parts whose
// pages are ranges of that order.

#include "libvox/io/merge_parts.h"

#include "libvox/core/error.h"
#include "libvox/core/memory.h"
#include "libvox/grid/openvdb.h"
#include "libvox/grid/pages.h"
#include "libvox/io/merge_report.h"
#include "libvox/io/parallel_grid.h"
#include "libvox/io/write_vdb.h"
#include "libvox/options/run_part.h"

#include <openvdb/io/Archive.h>
#include <openvdb/io/Compression.h>
#include <openvdb/io/DelayedLoadMetadata.h>
#include <openvdb/io/GridDescriptor.h>
#include <openvdb/io/io.h>

#include <algorithm>
#include <fstream>
#include <iostream>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace vox {
namespace {

/// The first and the last page of some, in the order of the file (grid/pages.h).
struct PagesOfTree {
  openvdb::Coord first, last;
};

template <class Node>
bool isBackground(const Node& node, openvdb::Index i, const typename Node::ValueType& background) {
  return !node.isChildMaskOn(i) && !node.isValueMaskOn(i) &&
         node.getTable()[i].getValue() == background;
}

/// The pages that are not background.
template <class TreeT>
std::optional<PagesOfTree> pagesOf(const TreeT& tree) {
  using Upper = typename TreeT::RootNodeType::ChildNodeType;
  std::optional<PagesOfTree> range;
  const auto add = [&](const openvdb::Coord& voxel) {
    const openvdb::Coord page = voxel >> kPageLog2;
    if (!range) range = {page, page};
    if (isBefore(page, range->first)) range->first = page;
    if (isBefore(range->last, page)) range->last = page;
  };
  for (auto upper = tree.root().cbeginChildOn(); upper; ++upper)
    for (openvdb::Index i = 0; i < Upper::NUM_VALUES; ++i)
      if (!isBackground(*upper, i, tree.background())) add(upper->offsetToGlobalCoord(i));
  for (auto tile = tree.root().cbeginValueAll(); tile; ++tile) {
    if (tile.isValueOff() && *tile == tree.background()) continue;
    add(tile.getCoord());
    add(tile.getCoord().offsetBy(Upper::DIM - 1));
  }
  return range;
}

/// Moves the pages of an upper node into another one, where they are background.
template <class Upper>
void movePages(Upper& from, Upper& to, const typename Upper::ValueType& background) {
  for (openvdb::Index i = 0; i < Upper::NUM_VALUES; ++i)
    if (!from.isChildMaskOn(i) && !isBackground(from, i, background))
      to.addTile(i, from.getTable()[i].getValue(), from.isValueMaskOn(i));
  std::vector<typename Upper::ChildNodeType*> pages;
  from.stealNodes(pages, background, false);
  for (auto* page : pages) to.addChild(page);
}

/// Upper nodes whose pages are all the same tile become tiles, as in a tree that was pruned.
template <class Root>
void pruneUppers(Root& root) {
  std::vector<openvdb::Coord> origins;
  for (auto child = root.cbeginChildOn(); child; ++child) origins.push_back(child->origin());
  for (const openvdb::Coord& origin : origins) {
    typename Root::ValueType value;
    bool active = false;
    if (root.template probeConstNode<typename Root::ChildNodeType>(origin)->isConstant(value,
                                                                                       active))
      root.addTile(origin, value, active);
  }
  root.eraseBackgroundTiles();
}

/// Moves all nodes and tiles of a tree into another one, where they are background.
template <class TreeT>
void moveNodes(TreeT& from, TreeT& to) {
  using Upper = typename TreeT::RootNodeType::ChildNodeType;
  for (auto tile = from.root().cbeginValueAll(); tile; ++tile)
    to.root().addTile(tile.getCoord(), *tile, tile.isValueOn());
  std::vector<Upper*> nodes;
  from.root().stealNodes(nodes);
  for (Upper* node : nodes) {
    Upper* const there = to.root().template probeNode<Upper>(node->origin());
    if (there == nullptr) {
      to.root().addChild(node);
      continue;
    }
    const std::unique_ptr<Upper> emptied(node);
    movePages(*node, *there, to.background());
  }
}

using openvdb::io::DelayedLoadMetadata;

/// Whether the packed sizes of leaves are stored. They are, too, where the file is compressed but
/// the grid is not: OpenVDB does not zip level sets and fog volumes.
bool hasSizes(const DelayedLoadMetadata& leaves) {
  DelayedLoadMetadata without(leaves);
  without.resizeCompressedSize(0);
  return !(without == leaves);
}

/// What OpenVDB stores about the values of each leaf, of the parts of a grid.
class LeafRecords {
 public:
  /// Adds those of a part with `count` leaves.
  /// @return  false if only some parts have packed sizes
  bool add(const DelayedLoadMetadata& part, std::size_t count) {
    if (count == 0) return true;
    const bool sizes = hasSizes(part);
    if (count_ > 0 && sizes != sizes_) return false;
    sizes_ = sizes;
    all_.resizeMask(count_ + count);
    if (sizes) all_.resizeCompressedSize(count_ + count);
    for (std::size_t i = 0; i < count; ++i, ++count_) {
      all_.setMask(count_, part.getMask(i));
      if (sizes) all_.setCompressedSize(count_, part.getCompressedSize(i));
    }
    return true;
  }
  const DelayedLoadMetadata& all() const { return all_; }

 private:
  DelayedLoadMetadata all_;
  std::size_t count_ = 0;
  bool sizes_ = false;
};

/// Parts of one grid that become one.
class GridParts {
 public:
  GridParts(const PartFiles& files, std::size_t index, std::uint64_t maxMemory)
      : files_(files.parts), index_(index), budget_(maxMemory) {
    if (!files.missing.empty())
      missing_ = partsText(files.missing) + " of " + std::to_string(files.count);
  }

  /// The grid with the nodes of all parts, and its metadata.
  openvdb::GridBase::ConstPtr join() {
    openvdb::GridBase::Ptr whole;
    using Kinds = openvdb::TypeList<openvdb::MaskGrid, openvdb::FloatGrid, openvdb::Vec3SGrid,
                                    openvdb::Int32Grid>;
    const std::string type = head(0).type();
    const bool known = head(0).apply<Kinds>(
        [&](const auto& typed) { whole = joinAs<std::decay_t<decltype(typed)>>(); });
    if (!known)
      throw InputError(files_[0].file.string() + ": parts with grids of type " + type +
                       " cannot be merged");
    const auto written =
        std::const_pointer_cast<openvdb::GridBase>(writtenInParallel(whole)->copyGrid());
    written->addStatsMetadata();
    written->insertMeta(openvdb::GridBase::META_FILE_COMPRESSION,
                        openvdb::StringMetadata(openvdb::io::compressionToString(compression())));
    if (leaves_) written->insertMeta(openvdb::GridBase::META_FILE_DELAYED_LOAD, leaves_->all());
    return written;
  }

  std::uint32_t compression() const { return files_[0].grids[index_].compression; }
  const openvdb::io::GridDescriptor& descriptor(std::size_t part) const {
    return *files_[part].grids[index_].descriptor;
  }

  /// Writes the packed values of all parts.
  void copyValues(std::ostream& stream) const {
    for (std::size_t part = 0; part < files_.size(); ++part) copyValues(part, stream);
  }

 private:
  const openvdb::GridBase& head(std::size_t part) const { return *files_[part].grids[index_].head; }
  std::string fileOf(std::size_t part) const { return files_[part].file.string(); }

  openvdb::MetaMap metadata() const {
    std::vector<const openvdb::MetaMap*> all;
    for (const VdbIndex& file : files_) all.push_back(file.grids[index_].head.get());
    return metadataOfWhole(files_, all);
  }

  template <class GridT>
  openvdb::GridBase::Ptr joinAs() {
    using Upper = typename GridT::TreeType::RootNodeType::ChildNodeType;
    openvdb::GridBase::Ptr whole;
    std::uint64_t below = 0;  // bytes of lower nodes and leaves
    std::uint64_t uppers = 0;
    for (std::size_t part = 0; part < files_.size(); ++part) {
      const openvdb::GridBase::Ptr read = readNodes(files_[part], index_);
      auto& tree = static_cast<GridT&>(*read).tree();
      const std::uint64_t bytes = read->memUsage();
      budget_.require(below + uppers * sizeof(Upper) + bytes, "the grid " + read->getName(),
                      "raise --max-memory, or merge where there is more");
      below += bytes - std::min<std::uint64_t>(bytes, tree.root().childCount() * sizeof(Upper));
      requireNewPages(tree, part);
      addLeavesOf(part, tree.leafCount());
      if (!whole) {
        whole = read;
        uppers = tree.root().childCount();
        continue;
      }
      auto& all = static_cast<GridT&>(*whole).tree();
      if (tree.background() != all.background())
        throw InputError(fileOf(part) + ": has another background than the parts before it");
      moveNodes(tree, all);
      uppers = all.root().childCount();
    }
    pruneUppers(static_cast<GridT&>(*whole).tree().root());
    whole->clearMetadata();
    const openvdb::MetaMap all = metadata();
    whole->insertMeta(all);
    if (!missing_.empty())
      whole->insertMeta(kMissingPartsMetadata, openvdb::StringMetadata(missing_));
    return whole;
  }

  /// Checks that the pages of a part come after those of the parts before it.
  template <class TreeT>
  void requireNewPages(const TreeT& tree, std::size_t part) {
    const auto range = pagesOf(tree);
    if (!range) return;
    if (last_ && !isBefore(last_->page, range->first))
      throw InputError(fileOf(part) + ": has voxels of the part " + fileOf(last_->part) +
                       " in the grid " + head(0).getName());
    last_ = {range->last, part};
  }

  void addLeavesOf(std::size_t part, std::size_t count) {
    const auto stored = head(part).template getMetadata<DelayedLoadMetadata>(
        openvdb::GridBase::META_FILE_DELAYED_LOAD);
    if (!stored) return;
    if (!leaves_) leaves_.emplace();
    if (!leaves_->add(*stored, count))
      throw InputError(fileOf(part) + ": has another compression than the parts before it");
  }

  void copyValues(std::size_t part, std::ostream& stream) const {
    std::ifstream file(files_[part].file, std::ios::binary);
    descriptor(part).seekToBlocks(file);
    std::vector<char> block(1 << 20);
    for (auto left = descriptor(part).getEndPos() - descriptor(part).getBlockPos(); left > 0;) {
      const auto size = std::min<std::int64_t>(left, static_cast<std::int64_t>(block.size()));
      if (!file.read(block.data(), size)) throw InputError(fileOf(part) + ": cannot be read");
      stream.write(block.data(), size);
      left -= size;
    }
  }

  struct LastPage {
    openvdb::Coord page;
    std::size_t part;
  };

  std::span<const VdbIndex> files_;
  std::size_t index_;
  MemoryBudget budget_;
  std::string missing_;                // parts, for the metadata
  std::optional<LastPage> last_;       // of the parts so far
  std::optional<LeafRecords> leaves_;  // of the parts so far
};

/// Writes files as openvdb::io::Archive::write does, but for the values of leaves.
class MergeArchive : public openvdb::io::Archive {
 public:
  explicit MergeArchive(std::ostream& stream) : stream_(stream) {
    openvdb::io::setStreamMetadataPtr(stream, properties_, /*transfer=*/false);
  }
  ~MergeArchive() override { openvdb::io::clearStreamMetadataPtr(stream_); }
  MergeArchive(const MergeArchive&) = delete;
  MergeArchive& operator=(const MergeArchive&) = delete;

  void writeHead(const openvdb::MetaMap& metadata, std::size_t gridCount) {
    constexpr bool kSeekable = true;
    writeHeader(stream_, kSeekable);
    metadata.writeMeta(stream_);
    const auto count = static_cast<std::int32_t>(gridCount);
    stream_.write(reinterpret_cast<const char*>(&count), sizeof count);
  }

  void writeGrid(const openvdb::GridBase& grid, const GridParts& parts) {
    openvdb::io::GridDescriptor descriptor = parts.descriptor(0);
    openvdb::io::setHalfFloat(stream_, grid.saveFloatAsHalf());
    descriptor.writeHeader(stream_);
    const std::int64_t places = stream_.tellp();
    descriptor.writeStreamPos(stream_);
    descriptor.setGridPos(stream_.tellp());
    const std::uint32_t compression = parts.compression();
    openvdb::io::setDataCompression(stream_, compression);
    stream_.write(reinterpret_cast<const char*>(&compression), sizeof compression);
    grid.writeMeta(stream_);
    grid.writeTransform(stream_);
    grid.writeTopology(stream_);
    descriptor.setBlockPos(stream_.tellp());
    parts.copyValues(stream_);
    descriptor.setEndPos(stream_.tellp());
    stream_.seekp(places);
    descriptor.writeStreamPos(stream_);
    descriptor.seekToEnd(stream_);
  }

 private:
  std::ostream& stream_;
  openvdb::io::StreamMetadata::Ptr properties_ = std::make_shared<openvdb::io::StreamMetadata>();
};

openvdb::MetaMap metadataOfFiles(std::span<const VdbIndex> files) {
  std::vector<const openvdb::MetaMap*> all;
  for (const VdbIndex& file : files) all.push_back(file.metadata.get());
  return metadataOfWhole(files, all);
}

}  // namespace

std::vector<MergedGrid> mergeParts(std::iostream& stream, const PartFiles& files,
                                   std::uint64_t maxMemory) {
  std::vector<MergedGrid> merged;
  const std::size_t gridCount = files.parts.front().grids.size();
  {
    MergeArchive archive(stream);
    archive.writeHead(metadataOfFiles(files.parts), gridCount);
    for (std::size_t i = 0; i < gridCount; ++i) {
      GridParts parts(files, i, maxMemory);
      const auto grid = parts.join();
      archive.writeGrid(*grid, parts);
      merged.push_back({grid->getName(), grid->activeVoxelCount()});
    }
  }
  nameByContent(stream);
  return merged;
}

}  // namespace vox
