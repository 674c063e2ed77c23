#pragma once

#include <openvdb/openvdb.h>

#include <iosfwd>
#include <vector>

namespace vox {

/// Writes grids in OpenVDB's own file format (Blosc and active-mask compression where the library
/// has them). The random UUID of the file is replaced by a hash of everything else in it, so equal
/// grids and metadata give equal bytes.
///
/// @param stream  empty, readable, writable and seekable: std::fstream, std::stringstream
/// @throws IoError  the stream fails
void writeVdb(std::iostream& stream, const std::vector<openvdb::GridBase::Ptr>& grids,
              const openvdb::MetaMap& fileMetadata);

/// Whether a file still has the content its UUID was made from.
enum class VdbContent {
  kForeign,  ///< the UUID is none of ours
  kIntact,
  kDamaged,
};
VdbContent vdbContent(std::istream& stream);

}  // namespace vox
