// OpenVDB files with reproducible bytes.

#include "libvox/io/write_vdb.h"

#include "libvox/core/error.h"
#include "libvox/core/hash.h"
#include "libvox/core/parallel.h"
#include "libvox/grid/openvdb.h"
#include "libvox/io/parallel_grid.h"

#include <openvdb/io/Archive.h>
#include <openvdb/io/Compression.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <iostream>
#include <iterator>
#include <string>
#include <utility>
#include <vector>

namespace vox {
namespace {

/// The file starts with magic (8 bytes), format version (4), library version (4 + 4), a flag (1)
/// and then the UUID as 36 characters.
constexpr std::streamoff kUuidOffset = 21;
constexpr std::size_t kUuidLength = 36;
constexpr std::array<std::size_t, 4> kDashes = {8, 13, 18, 23};

/// Makes Archive::write usable for any seekable stream. (openvdb::io::File writes to a path only
/// and does not report a full disk.)
class SeekableArchive : public openvdb::io::Archive {
 public:
  void writeTo(std::ostream& out, const openvdb::GridCPtrVec& grids,
               const openvdb::MetaMap& metadata) const {
    constexpr bool kSeekable = true;
    Archive::write(out, grids, kSeekable, metadata);
  }
};

bool isThere(Compression compression) {
  if (compression == Compression::kBlosc) return openvdb::io::Archive::hasBloscCompression();
  if (compression == Compression::kZip) return openvdb::io::Archive::hasZLibCompression();
  return true;
}

std::uint32_t flagsOf(Compression compression) {
  if (compression == Compression::kBlosc)
    return openvdb::io::COMPRESS_BLOSC | openvdb::io::COMPRESS_ACTIVE_MASK;
  if (compression == Compression::kZip)
    return openvdb::io::COMPRESS_ZIP | openvdb::io::COMPRESS_ACTIVE_MASK;
  return openvdb::io::COMPRESS_ACTIVE_MASK;
}

Compression bestCompression() {
  for (const auto& [compression, name] : kCompressionNames)
    if (isThere(compression)) return compression;
  return Compression::kPlain;
}

using Block = std::vector<char>;

/// @return  number of bytes read: less than the block has at the end of the stream
std::size_t readBlock(std::istream& stream, Block& block) {
  stream.read(block.data(), static_cast<std::streamsize>(block.size()));
  return static_cast<std::size_t>(stream.gcount());
}

/// Hash of the whole stream, with zeros in place of the UUID.
std::string contentHash(std::istream& stream) {
  ContentHash hash;
  Block block(1 << 18);
  Block next(block.size());
  stream.seekg(0);
  std::size_t size = readBlock(stream, block);
  std::memset(block.data() + kUuidOffset, '0', kUuidLength);
  while (size > 0) {
    std::size_t nextSize = 0;
    parallelForEach(2, 1, [&](int task) {
      if (task == 0)
        hash.add({block.data(), size});
      else
        nextSize = readBlock(stream, next);
    });
    std::swap(block, next);
    size = nextSize;
  }
  if (stream.bad()) throw IoError("the output cannot be read back");
  stream.clear();
  return hash.hex();
}

/// A hash as a UUID of version 8, whose content is free (RFC 9562).
std::string asUuid(std::string hex) {
  hex[12] = '8';
  hex[16] = 'a';
  for (const std::size_t dash : kDashes) hex.insert(dash, "-");
  return hex;
}

/// The UUID of the file; empty if the text at its place is none.
std::string readUuid(std::istream& stream) {
  std::string uuid(kUuidLength, '\0');
  stream.seekg(kUuidOffset);
  stream.read(uuid.data(), kUuidLength);
  const bool dashed = std::all_of(kDashes.begin(), kDashes.end(),
                                  [&](std::size_t dash) { return uuid[dash] == '-'; });
  return stream && dashed ? uuid : std::string();
}

void replaceUuid(std::iostream& stream) {
  if (readUuid(stream).empty())
    throw IoError("this version of OpenVDB keeps the UUID of a file elsewhere");
  const std::string name = asUuid(contentHash(stream));
  stream.seekp(kUuidOffset);
  stream.write(name.data(), static_cast<std::streamsize>(name.size()));
}

}  // namespace

void writeVdb(std::iostream& stream, const std::vector<openvdb::GridBase::Ptr>& grids,
              const openvdb::MetaMap& fileMetadata, std::optional<Compression> compression) {
  SeekableArchive archive;
  archive.setCompression(flagsOf(compression.value_or(bestCompression())));
  openvdb::GridCPtrVec views;
  std::transform(grids.begin(), grids.end(), std::back_inserter(views), writtenInParallel);
  try {
    archive.writeTo(stream, views, fileMetadata);
  } catch (const openvdb::Exception& error) {
    throw IoError(std::string("OpenVDB cannot write the grids: ") + error.what());
  }
  nameByContent(stream);
}

void nameByContent(std::iostream& stream) {
  if (stream.flush()) replaceUuid(stream);
  if (!stream.flush()) throw IoError("the output cannot be written; is the disk full?");
}

void requireCompression(Compression compression) {
  if (isThere(compression)) return;
  throw UsageError("this OpenVDB has no compression " + nameIn(kCompressionNames, compression) +
                   "; leave it out to use the best there is");
}

VdbContent vdbContent(std::istream& stream) {
  const std::string uuid = readUuid(stream);
  constexpr std::size_t kVersionDigit = 14;
  if (uuid.empty() || uuid[kVersionDigit] != '8') return VdbContent::kForeign;
  return uuid == asUuid(contentHash(stream)) ? VdbContent::kIntact : VdbContent::kDamaged;
}

}  // namespace vox
