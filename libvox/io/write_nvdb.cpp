// NanoVDB files with reproducible bytes, by NanoVDB's own converter and writer.

#include "libvox/io/write_nvdb.h"

#include "libvox/core/error.h"
#include "libvox/grid/openvdb.h"

#include <nanovdb/util/IO.h>
#include <nanovdb/util/OpenToNanoVDB.h>

#include <cstddef>
#include <iostream>
#include <memory>
#include <stdexcept>
#include <string>
#include <type_traits>

namespace vox {
namespace {

/// Memory of a NanoVDB grid, zero at first: the converter leaves gaps between values, which would
/// carry bytes of other memory into the file.
class ZeroedBuffer {
 public:
  static ZeroedBuffer create(std::uint64_t size, const ZeroedBuffer* /*pool*/ = nullptr) {
    ZeroedBuffer buffer;
    buffer.size_ = size;
    buffer.blocks_ = std::make_unique<Block[]>((size + sizeof(Block) - 1) / sizeof(Block));
    return buffer;
  }

  std::uint8_t* data() { return size_ > 0 ? blocks_[0].bytes : nullptr; }
  const std::uint8_t* data() const { return size_ > 0 ? blocks_[0].bytes : nullptr; }
  std::uint64_t size() const { return size_; }
  void clear() { *this = {}; }

 private:
  struct alignas(NANOVDB_DATA_ALIGNMENT) Block {
    std::uint8_t bytes[NANOVDB_DATA_ALIGNMENT];
  };
  std::unique_ptr<Block[]> blocks_;
  std::uint64_t size_ = 0;
};

using Handle = nanovdb::GridHandle<ZeroedBuffer>;

/// The types that NanoVDB's converter takes without loss, both ways.
using HeldTypes =
    openvdb::TypeList<openvdb::FloatGrid, openvdb::DoubleGrid, openvdb::Int32Grid,
                      openvdb::Int64Grid, openvdb::Vec3SGrid, openvdb::MaskGrid, openvdb::BoolGrid>;

/// NanoVDB's validation refuses classes that have no meaning for a type: they become unknown.
template <class Grid>
openvdb::GridClass heldClass(const Grid& grid) {
  using Value = typename Grid::ValueType;
  switch (grid.getGridClass()) {
    case openvdb::GRID_LEVEL_SET:
    case openvdb::GRID_FOG_VOLUME:
      return std::is_floating_point_v<Value> ? grid.getGridClass() : openvdb::GRID_UNKNOWN;
    case openvdb::GRID_STAGGERED:
      return openvdb::VecTraits<Value>::IsVec ? openvdb::GRID_STAGGERED : openvdb::GRID_UNKNOWN;
    default:
      return openvdb::GRID_UNKNOWN;
  }
}

/// The converter takes the place of a node from the box of its active voxels. If it has none, its
/// children would be lost. An empty box, too, can have the right place.
template <class Node>
void placeIfEmpty(Node& node, const openvdb::Coord& origin) {
  auto& box = node.data()->mBBox;
  if (!box.empty()) return;
  const nanovdb::Coord place(origin.x(), origin.y(), origin.z());
  box.min() = place;
  box.max() = place - nanovdb::Coord(1);
}

/// @param nano  made from `tree`: its nodes are in the order in which those of the tree are visited
template <class Tree, class NanoGrid>
void placeEmptyNodes(const Tree& tree, NanoGrid& nano) {
  auto* upper = nano.tree().template getFirstNode<2>();
  auto* lower = nano.tree().template getFirstNode<1>();
  for (auto open2 = tree.root().cbeginChildOn(); open2; ++open2) {
    placeIfEmpty(*upper++, open2->origin());
    for (auto open1 = open2->cbeginChildOn(); open1; ++open1)
      placeIfEmpty(*lower++, open1->origin());
  }
}

/// Averages are left out: their last bits depend on the number of threads.
template <class Grid>
Handle encoded(Grid& grid) {
  using Tree = typename Grid::TreeType;
  using Build = typename nanovdb::OpenToNanoType<typename Tree::BuildType>::Type;
  const typename Grid::Ptr held = grid.copy();  // the same tree
  held->setGridClass(heldClass(grid));
  const bool isEmpty = grid.activeVoxelCount() == 0;  // then NanoVDB prints a warning about it
  Handle handle = nanovdb::openToNanoVDB<ZeroedBuffer>(
      *held, isEmpty ? nanovdb::StatsMode::Disable : nanovdb::StatsMode::MinMax,
      nanovdb::ChecksumMode::Disable);
  auto& nano = *handle.template grid<Build>();
  placeEmptyNodes(grid.tree(), nano);
  nanovdb::updateChecksum(nano, nanovdb::ChecksumMode::Full);
  return handle;
}

nanovdb::io::Codec codecOf(Compression compression) {
  if (compression == Compression::kBlosc) return nanovdb::io::Codec::BLOSC;
  if (compression == Compression::kZip) return nanovdb::io::Codec::ZIP;
  return nanovdb::io::Codec::NONE;
}

/// Writes a grid as a segment of its own, so that the next one can take its memory.
void writeSegment(std::ostream& stream, openvdb::GridBase& grid, nanovdb::io::Codec codec) {
  if (!grid.transform().isLinear())
    throw InputError("grid " + grid.getName() +
                     ": NanoVDB has no transform with perspective; write a .vdb file");
  const bool held = grid.apply<HeldTypes>(
      [&](auto& typed) { nanovdb::io::writeGrid(stream, encoded(typed), codec); });
  if (!held)
    throw InputError("grid " + grid.getName() + ": NanoVDB has no grids of type " + grid.type() +
                     "; write a .vdb file");
}

}  // namespace

void writeNvdb(std::iostream& stream, const std::vector<openvdb::GridBase::Ptr>& grids,
               std::optional<Compression> compression) {
  const nanovdb::io::Codec codec = codecOf(compression.value_or(Compression::kBlosc));
  try {
    for (const auto& grid : grids) writeSegment(stream, *grid, codec);
  } catch (const Error&) {  // Cancelled, say, by the stream
    throw;
  } catch (const std::runtime_error&) {
    if (stream) throw;
    throw IoError("the output cannot be written; is the disk full?");
  }
  if (!stream.flush()) throw IoError("the output cannot be written; is the disk full?");
}

}  // namespace vox
