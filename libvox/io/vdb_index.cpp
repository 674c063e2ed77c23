// The heads and nodes of grids, as openvdb::io::File reads them, but without the values.

#include "libvox/io/vdb_index.h"

#include "libvox/core/error.h"
#include "libvox/grid/openvdb.h"
#include "libvox/io/input_file.h"

#include <openvdb/io/Archive.h>
#include <openvdb/io/GridDescriptor.h>
#include <openvdb/io/io.h>

#include <fstream>
#include <functional>
#include <utility>

namespace vox {
namespace {

/// An openvdb::io::File whose stream fails aloud.
class IndexArchive : public openvdb::io::Archive {
 public:
  explicit IndexArchive(const std::filesystem::path& file) : stream_(file, std::ios::binary) {
    stream_.exceptions(std::ios::badbit | std::ios::failbit);
    openvdb::io::setStreamMetadataPtr(stream_, properties_, /*transfer=*/false);
    readHeader(stream_);
    setFormatVersion(stream_);
    setLibraryVersion(stream_);
    setDataCompression(stream_);
  }

  /// What follows the header.
  void read(VdbIndex& index) {
    index.format = openvdb::io::getFormatVersion(stream_);
    auto metadata = std::make_shared<openvdb::MetaMap>();
    metadata->readMeta(stream_);
    index.metadata = metadata;
    for (auto left = readGridCount(stream_); left > 0; --left) {
      openvdb::io::GridDescriptor descriptor;
      VdbIndexGrid grid;
      auto head = descriptor.read(stream_);
      grid.compression = readHead(descriptor, *head);
      grid.treePosition = stream_.tellg();
      grid.head = head;
      descriptor.seekToEnd(stream_);
      grid.descriptor = std::make_shared<openvdb::io::GridDescriptor>(descriptor);
      index.grids.push_back(std::move(grid));
    }
  }

  void readNodes(const openvdb::io::GridDescriptor& descriptor, openvdb::GridBase& grid) {
    readHead(descriptor, grid);
    grid.readTopology(stream_);
    if (stream_.tellg() != descriptor.getBlockPos())
      throw openvdb::IoError("the values do not follow the nodes");
  }

 private:
  /// @return  the flags of compression of the grid
  std::uint32_t readHead(const openvdb::io::GridDescriptor& descriptor, openvdb::GridBase& grid) {
    descriptor.seekToGrid(stream_);
    readGridCompression(stream_);
    grid.setSaveFloatAsHalf(descriptor.saveFloatAsHalf());
    openvdb::io::setHalfFloat(stream_, descriptor.saveFloatAsHalf());
    openvdb::io::setGridBackgroundValuePtr(stream_, nullptr);
    grid.readMeta(stream_);
    openvdb::io::setGridClass(stream_, grid.getGridClass());
    grid.readTransform(stream_);
    return openvdb::io::getDataCompression(stream_);
  }

  openvdb::io::StreamMetadata::Ptr properties_ = std::make_shared<openvdb::io::StreamMetadata>();
  std::ifstream stream_;
};

/// @throws InputError  for whatever OpenVDB throws
void named(const std::filesystem::path& file, const std::function<void()>& work) {
  openvdb::initialize();
  try {
    work();
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& wrong) {
    throw InputError(file.string() + ": cannot be read as OpenVDB: " + wrong.what());
  }
}

std::int64_t treeBytes(const VdbIndexGrid& grid) {
  return grid.descriptor->getEndPos() - grid.treePosition;
}

/// Whether both grids are stored in one way.
bool areStoredAlike(const VdbIndex& a, const VdbIndexGrid& one, const VdbIndex& b,
                    const VdbIndexGrid& other) {
  const auto& x = *one.descriptor;
  const auto& y = *other.descriptor;
  return a.format == b.format && x.gridType() == y.gridType() &&
         one.compression == other.compression && x.saveFloatAsHalf() == y.saveFloatAsHalf() &&
         one.head->getGridClass() == other.head->getGridClass() && !x.isInstance() &&
         !y.isInstance();
}

}  // namespace

VdbIndex readVdbIndex(const std::filesystem::path& file) {
  VdbIndex index;
  index.file = file;
  named(file, [&] { IndexArchive(file).read(index); });
  return index;
}

std::shared_ptr<openvdb::GridBase> readNodes(const VdbIndex& index, std::size_t grid) {
  const openvdb::io::GridDescriptor& descriptor = *index.grids[grid].descriptor;
  std::shared_ptr<openvdb::GridBase> read;
  named(index.file, [&] {
    read = openvdb::GridBase::createGrid(descriptor.gridType());
    IndexArchive(index.file).readNodes(descriptor, *read);
  });
  return read;
}

bool haveSameTree(const VdbIndex& a, std::size_t gridA, const VdbIndex& b, std::size_t gridB) {
  const VdbIndexGrid& one = a.grids[gridA];
  const VdbIndexGrid& other = b.grids[gridB];
  const std::int64_t size = treeBytes(one);
  if (!areStoredAlike(a, one, b, other) || size != treeBytes(other) || size <= 0) return false;
  return haveSameBytes(a.file, static_cast<std::uint64_t>(one.treePosition), b.file,
                       static_cast<std::uint64_t>(other.treePosition),
                       static_cast<std::uint64_t>(size));
}

}  // namespace vox
