// Serializes and compresses the nodes of a grid on all threads. The bytes are those of OpenVDB 10:
// writeTopology and writeBuffers of Tree, RootNode, InternalNode and the leaves.

#include "libvox/io/parallel_grid.h"

#include "libvox/grid/openvdb.h"
#include "libvox/io/ordered_parts.h"
#include "libvox/io/tree_statistics.h"

#include <openvdb/io/Compression.h>
#include <openvdb/io/io.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <ostream>
#include <span>
#include <type_traits>
#include <vector>

namespace vox {
namespace {

template <class Value>
void writePlain(std::ostream& stream, const Value& value) {
  stream.write(reinterpret_cast<const char*>(&value), sizeof(Value));
}

/// Copies a mask and returns the end of the copy.
template <class Mask>
char* copyMask(const Mask& mask, char* to) {
  for (openvdb::Index i = 0; i < Mask::WORD_COUNT; ++i, to += sizeof(openvdb::Index64)) {
    const auto word = mask.template getWord<openvdb::Index64>(i);
    std::memcpy(to, &word, sizeof(word));
  }
  return to;
}

/// Of a part, about; small enough for the memory, large enough for fast writing to a file.
constexpr std::size_t kBytesOfPart = 256 * 1024;

/// Calls write(element, to) for all elements. Parts are runs of elements whose estimated bytes,
/// without the last element's, are less than those of a part.
template <class Element, class BytesOf, class Write>
void writeRuns(std::ostream& stream, const std::vector<Element>& elements, const BytesOf& bytesOf,
               const Write& write) {
  std::vector<std::size_t> begins = {0};
  std::size_t bytes = 0;
  for (std::size_t i = 0; i < elements.size(); ++i) {
    bytes += bytesOf(elements[i]);
    if (bytes < kBytesOfPart && i + 1 < elements.size()) continue;
    begins.push_back(i + 1);
    bytes = 0;
  }
  writeInOrder(stream, begins.size() - 1, [&](std::size_t part, PartBytes& to) {
    for (std::size_t i = begins[part]; i != begins[part + 1]; ++i) write(elements[i], to);
  });
}

/// How values are written to a stream.
struct ValueFormat {
  openvdb::io::StreamMetadata metadata;  ///< compression, background
  bool half;
};

/// A stream for OpenVDB's own functions.
class PartStream : public std::ostream {
 public:
  PartStream(PartBytes& to, const ValueFormat& format) : std::ostream(&to) {
    exceptions(std::ios::badbit);  // otherwise bad_alloc would be lost, and bytes missing
    auto metadata = std::make_shared<openvdb::io::StreamMetadata>(format.metadata);
    openvdb::io::setStreamMetadataPtr(*this, metadata);
  }
};

template <class TreeT>
class ParallelGrid : public openvdb::Grid<TreeT> {
 public:
  explicit ParallelGrid(openvdb::Grid<TreeT>& grid)
      : openvdb::Grid<TreeT>(grid, openvdb::ShallowCopy()),
        statistics_(statisticsOf(grid.constTree())) {}

  /// Archives write the metadata of a copy, to which they add the statistics.
  openvdb::GridBase::ConstPtr copyGrid() const override {
    return openvdb::GridBase::ConstPtr(new ParallelGrid(*this));
  }
  openvdb::Index64 activeVoxelCount() const override { return statistics_.activeVoxels; }
  openvdb::CoordBBox evalActiveVoxelBoundingBox() const override { return statistics_.box; }
  openvdb::Index64 memUsage() const override { return statistics_.bytes; }

  /// The root, then depth first: masks and tiles of each node, then its children.
  void writeTopology(std::ostream& stream) const override {
    this->tree().openvdb::TreeBase::writeTopology(stream);
    writeRoot(stream);
    std::vector<Node> nodes;
    for (auto upper = root().cbeginChildOn(); upper; ++upper) {
      nodes.push_back({upper.getCoord(), &*upper, nullptr});
      for (auto lower = upper->cbeginChildOn(); lower; ++lower)
        nodes.push_back({{}, nullptr, &*lower});
    }
    const ValueFormat format = formatOf(stream);
    const PartBytes noTiles = valuesWithoutTiles(format);
    const auto bytesOf = [](const Node& node) {
      return node.lower == nullptr ? kBytesOfPart : bytesOfMasks(*node.lower);
    };
    writeRuns<Node>(stream, nodes, bytesOf, [&](const Node& node, PartBytes& to) {
      if (node.upper != nullptr)
        writeUpper(*node.upper, node.origin, format, to);
      else
        writeLower(*node.lower, noTiles.bytes(), format, to);
    });
  }

  /// The leaves, in the order of the tree.
  void writeBuffers(std::ostream& stream) const override {
    if constexpr (kIsMask)
      writeMasksOfLeaves(stream);
    else
      writeValuesOfLeaves(stream);
  }

 private:
  using Root = typename TreeT::RootNodeType;
  using Upper = typename Root::ChildNodeType;
  using Lower = typename Upper::ChildNodeType;
  using Leaf = typename TreeT::LeafNodeType;
  using Value = typename TreeT::ValueType;

  static constexpr bool kIsMask = std::is_same_v<typename TreeT::BuildType, openvdb::ValueMask>;
  static constexpr std::size_t kMaskBytes = Leaf::SIZE / 8;

  /// An upper node without its children, or a lower node with the masks of its leaves.
  struct Node {
    openvdb::Coord origin;  ///< of the upper node
    const Upper* upper;
    const Lower* lower;
  };

  /// Bytes of the masks of a node and of its leaves, in the file.
  static std::size_t bytesOfMasks(const Lower& node) {
    return 2 * Lower::NUM_VALUES / 8 + node.getChildMask().countOn() * kMaskBytes;
  }

  ParallelGrid(const ParallelGrid& other)
      : openvdb::Grid<TreeT>(const_cast<ParallelGrid&>(other), openvdb::ShallowCopy()),
        statistics_(other.statistics_) {}

  const Root& root() const { return this->constTree().root(); }

  ValueFormat formatOf(std::ostream& stream) const {
    ValueFormat format{openvdb::io::StreamMetadata(stream), this->saveFloatAsHalf()};
    format.metadata.setBackgroundPtr(&root().background());
    return format;
  }

  void writeRoot(std::ostream& stream) const {
    const Value& background = root().background();
    const bool half = this->saveFloatAsHalf();
    writePlain(stream, half ? Value(openvdb::io::truncateRealToHalf(background)) : background);
    const openvdb::Index children = root().childCount();
    writePlain(stream, root().getTableSize() - children);
    writePlain(stream, children);
    for (auto tile = root().cbeginValueAll(); tile; ++tile) {
      writePlain(stream, tile.getCoord());
      writePlain(stream, *tile);
      writePlain(stream, tile.isValueOn());
    }
  }

  static void writeUpper(const Upper& node, const openvdb::Coord& origin, const ValueFormat& format,
                         PartBytes& to) {
    PartStream stream(to, format);
    writePlain(stream, origin);
    node.getChildMask().save(stream);
    node.getValueMask().save(stream);
    const auto values = std::make_unique<Value[]>(Upper::NUM_VALUES);
    for (openvdb::Index i = 0; i < Upper::NUM_VALUES; ++i)
      values[i] = node.isChildMaskOn(i) ? openvdb::zeroVal<Value>() : node.getTable()[i].getValue();
    openvdb::io::writeCompressedValues(stream, values.get(), Upper::NUM_VALUES, node.getValueMask(),
                                       node.getChildMask(), format.half);
  }

  /// @param noTiles  of valuesWithoutTiles
  void writeLower(const Lower& node, std::span<const char> noTiles, const ValueFormat& format,
                  PartBytes& to) const {
    if (noTiles.empty() || !hasNoTiles(node)) {
      PartStream stream(to, format);
      return node.writeTopology(stream, format.half);
    }
    char* at = to.extend(bytesOfMasks(node) + noTiles.size());
    at = copyMask(node.getChildMask(), at);
    at = copyMask(node.getValueMask(), at);
    at = std::copy(noTiles.begin(), noTiles.end(), at);
    for (auto leaf = node.cbeginChildOn(); leaf; ++leaf) at = copyMask(leaf->valueMask(), at);
  }

  using Compress = openvdb::io::MaskCompress<Value, typename Lower::NodeMaskType>;

  /// Whether all values of a lower node are inactive background.
  bool hasNoTiles(const Lower& node) const {
    if (!node.getValueMask().isOff()) return false;
    const Value& background = root().background();
    const auto* const table = node.getTable();
    constexpr openvdb::Index kBits = 64;
    bool same = true;
    for (openvdb::Index begin = 0; same && begin < Lower::NUM_VALUES; begin += kBits) {
      const auto children = node.getChildMask().template getWord<openvdb::Index64>(begin / kBits);
      for (openvdb::Index i = 0; i < kBits; ++i)
        if ((children >> i & 1) == 0) same &= Compress::eq(table[begin + i].getValue(), background);
    }
    return same;
  }

  /// The values of a lower node that has no tiles, as OpenVDB writes them: they do not depend on
  /// which children it has. Empty if they do, for want of compression by masks.
  PartBytes valuesWithoutTiles(const ValueFormat& format) const {
    PartBytes bytes;
    if ((format.metadata.compression() & openvdb::io::COMPRESS_ACTIVE_MASK) == 0) return bytes;
    PartStream stream(bytes, format);
    const auto values = std::make_unique<Value[]>(Lower::NUM_VALUES);
    std::fill_n(values.get(), Lower::NUM_VALUES, root().background());
    const typename Lower::NodeMaskType none;
    openvdb::io::writeCompressedValues(stream, values.get(), Lower::NUM_VALUES, none, none,
                                       format.half);
    return bytes;
  }

  void writeMasksOfLeaves(std::ostream& stream) const {
    std::vector<const Lower*> nodes;
    this->constTree().getNodes(nodes);
    constexpr std::size_t kOriginBytes = 3 * sizeof(openvdb::Coord::ValueType);
    const auto bytesOf = [](const Lower* node) { return bytesOfMasks(*node); };
    writeRuns<const Lower*>(stream, nodes, bytesOf, [](const Lower* node, PartBytes& to) {
      char* at = to.extend(node->getChildMask().countOn() * (kMaskBytes + kOriginBytes));
      for (auto leaf = node->cbeginChildOn(); leaf; ++leaf, at += kOriginBytes) {
        at = copyMask(leaf->valueMask(), at);
        std::memcpy(at, leaf->origin().data(), kOriginBytes);
      }
    });
  }

  void writeValuesOfLeaves(std::ostream& stream) const {
    std::vector<const Leaf*> leaves;
    this->constTree().getNodes(leaves);
    const ValueFormat format = formatOf(stream);
    constexpr std::size_t kLeaves = kBytesOfPart / (Leaf::SIZE * sizeof(Value));
    writeInOrder(stream, (leaves.size() + kLeaves - 1) / kLeaves,
                 [&](std::size_t i, PartBytes& to) {
                   PartStream part(to, format);
                   const auto own = std::span(leaves).subspan(i * kLeaves);
                   for (const Leaf* leaf : own.first(std::min(own.size(), kLeaves)))
                     leaf->writeBuffers(part, format.half);
                 });
  }

  TreeStatistics statistics_;
};

/// The grid as a ParallelGrid; null if it has another type of tree.
template <class TreeT>
openvdb::GridBase::ConstPtr inParallelIf(const openvdb::GridBase::Ptr& grid) {
  const auto typed = openvdb::gridPtrCast<openvdb::Grid<TreeT>>(grid);
  return typed ? std::make_shared<ParallelGrid<TreeT>>(*typed) : nullptr;
}

}  // namespace

openvdb::GridBase::ConstPtr writtenInParallel(const openvdb::GridBase::Ptr& grid) {
  if (auto mask = inParallelIf<openvdb::MaskTree>(grid)) return mask;
  if (auto numbers = inParallelIf<openvdb::FloatTree>(grid)) return numbers;
  if (auto vectors = inParallelIf<openvdb::Vec3STree>(grid)) return vectors;
  if (auto labels = inParallelIf<openvdb::Int32Tree>(grid)) return labels;
  return grid;
}

}  // namespace vox
