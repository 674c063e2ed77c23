// Serializes and compresses the leaves of a grid on all threads.

#include "libvox/io/parallel_grid.h"

#include "libvox/core/parallel.h"
#include "libvox/grid/openvdb.h"

#include <openvdb/io/io.h>

#include <algorithm>
#include <memory>
#include <ostream>
#include <span>
#include <streambuf>
#include <vector>

namespace vox {
namespace {

/// A stream buffer whose memory is reused: to get fresh pages of memory costs more than to write to
/// them.
class Bytes : public std::streambuf {
 public:
  void clear() { bytes_.clear(); }
  std::span<const char> bytes() const { return bytes_; }

 protected:
  std::streamsize xsputn(const char* bytes, std::streamsize count) override {
    bytes_.insert(bytes_.end(), bytes, bytes + count);
    return count;
  }
  int_type overflow(int_type byte) override {
    if (!traits_type::eq_int_type(byte, traits_type::eof()))
      bytes_.push_back(traits_type::to_char_type(byte));
    return traits_type::not_eof(byte);
  }

 private:
  std::vector<char> bytes_;
};

template <class TreeT>
class ParallelGrid : public openvdb::Grid<TreeT> {
 public:
  explicit ParallelGrid(openvdb::Grid<TreeT>& grid)
      : openvdb::Grid<TreeT>(grid, openvdb::ShallowCopy()) {}

  void writeBuffers(std::ostream& stream) const override {
    std::vector<const Leaf*> leaves;  // in the order in which the tree writes them
    this->tree().getNodes(leaves);
    constexpr std::size_t kLeavesOfPart = 32;
    constexpr std::size_t kMostParts = 64;
    Format format{openvdb::io::StreamMetadata(stream), this->saveFloatAsHalf()};
    format.metadata.setBackgroundPtr(&this->tree().root().background());
    std::vector<Bytes> parts(kMostParts);
    for (std::span<const Leaf* const> left = leaves; !left.empty();) {
      const auto now = left.first(std::min(left.size(), kMostParts * kLeavesOfPart));
      left = left.subspan(now.size());
      const std::size_t count = (now.size() + kLeavesOfPart - 1) / kLeavesOfPart;
      parallelForEach(count, 1, [&](std::size_t i) {
        const auto part = now.subspan(i * kLeavesOfPart);
        write(part.first(std::min(part.size(), kLeavesOfPart)), format, parts[i]);
      });
      for (std::size_t i = 0; i < count; ++i)
        stream.write(parts[i].bytes().data(),
                     static_cast<std::streamsize>(parts[i].bytes().size()));
    }
  }

 private:
  using Leaf = typename TreeT::LeafNodeType;

  /// Format in which leaves are written.
  struct Format {
    openvdb::io::StreamMetadata metadata;  ///< compression, background
    bool half;
  };

  static void write(std::span<const Leaf* const> leaves, const Format& format, Bytes& to) {
    to.clear();
    std::ostream stream(&to);
    stream.exceptions(std::ios::badbit);  // otherwise bad_alloc would be lost, and bytes missing
    auto metadata = std::make_shared<openvdb::io::StreamMetadata>(format.metadata);
    openvdb::io::setStreamMetadataPtr(stream, metadata);
    for (const Leaf* leaf : leaves) leaf->writeBuffers(stream, format.half);
  }
};

/// The grid as a ParallelGrid; null if it has another type of tree.
template <class TreeT>
openvdb::GridBase::ConstPtr inParallelIf(const openvdb::GridBase::Ptr& grid) {
  const auto typed = openvdb::gridPtrCast<openvdb::Grid<TreeT>>(grid);
  return typed ? std::make_shared<ParallelGrid<TreeT>>(*typed) : nullptr;
}

}  // namespace

openvdb::GridBase::ConstPtr writtenInParallel(const openvdb::GridBase::Ptr& grid) {
  if (auto numbers = inParallelIf<openvdb::FloatTree>(grid)) return numbers;
  if (auto vectors = inParallelIf<openvdb::Vec3STree>(grid)) return vectors;
  if (auto labels = inParallelIf<openvdb::Int32Tree>(grid)) return labels;
  return grid;
}

}  // namespace vox
