// Leaves to bytes, several at a time.

#include "libvox/io/parallel_grid.h"

#include "libvox/core/parallel.h"

#include <openvdb/io/io.h>

#include <algorithm>
#include <memory>
#include <span>
#include <sstream>
#include <string>
#include <vector>

namespace vox {
namespace {

template <class TreeT>
class ParallelGrid : public openvdb::Grid<TreeT> {
 public:
  explicit ParallelGrid(openvdb::Grid<TreeT>& grid)
      : openvdb::Grid<TreeT>(grid, openvdb::ShallowCopy()) {}

  void writeBuffers(std::ostream& stream) const override {
    std::vector<const Leaf*> leaves;  // in the order in which the tree writes them
    this->tree().getNodes(leaves);
    constexpr std::size_t kLeavesOfPart = 128;
    constexpr std::size_t kMostParts = 32;
    Format format{openvdb::io::StreamMetadata(stream), this->saveFloatAsHalf()};
    format.metadata.setBackgroundPtr(&this->tree().root().background());
    std::vector<std::string> parts;
    for (std::span<const Leaf* const> left = leaves; !left.empty();) {
      const auto now = left.first(std::min(left.size(), kMostParts * kLeavesOfPart));
      left = left.subspan(now.size());
      parts.resize((now.size() + kLeavesOfPart - 1) / kLeavesOfPart);
      forEach(parts.size(), 1, [&](std::size_t i) {
        const auto part = now.subspan(i * kLeavesOfPart);
        parts[i] = bytesOf(part.first(std::min(part.size(), kLeavesOfPart)), format);
      });
      for (const std::string& bytes : parts)
        stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
    }
  }

 private:
  using Leaf = typename TreeT::LeafNodeType;

  /// How leaves are written.
  struct Format {
    openvdb::io::StreamMetadata metadata;  ///< compression, background
    bool half;
  };

  static std::string bytesOf(std::span<const Leaf* const> leaves, const Format& format) {
    std::ostringstream stream(std::ios::binary);
    stream.exceptions(std::ios::badbit);  // else no memory would mean no bytes, and no error
    auto metadata = std::make_shared<openvdb::io::StreamMetadata>(format.metadata);
    openvdb::io::setStreamMetadataPtr(stream, metadata);
    for (const Leaf* leaf : leaves) leaf->writeBuffers(stream, format.half);
    return std::move(stream).str();
  }
};

/// Null if the grid is of another type.
template <class TreeT>
openvdb::GridBase::ConstPtr inParallelIf(const openvdb::GridBase::Ptr& grid) {
  const auto typed = openvdb::gridPtrCast<openvdb::Grid<TreeT>>(grid);
  return typed ? std::make_shared<ParallelGrid<TreeT>>(*typed) : nullptr;
}

}  // namespace

openvdb::GridBase::ConstPtr writtenInParallel(const openvdb::GridBase::Ptr& grid) {
  if (auto numbers = inParallelIf<openvdb::FloatTree>(grid)) return numbers;
  if (auto vectors = inParallelIf<openvdb::Vec3STree>(grid)) return vectors;
  return grid;
}

}  // namespace vox
