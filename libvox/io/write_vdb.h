#pragma once

#include "libvox/grid/openvdb_fwd.h"
#include "libvox/options/volume_options.h"

#include <iosfwd>
#include <memory>
#include <optional>
#include <vector>

namespace vox {

/// Writes grids in OpenVDB's own file format; values that are not active are left out. The random
/// UUID of the file is replaced by a hash of everything else in it, so equal grids and metadata
/// give equal bytes. Leaves are packed on all threads of the caller's arena.
///
/// @param compression  default: Blosc, or else zip, or else none, whichever the library has
/// @param stream  empty, readable, writable and seekable: std::fstream, std::stringstream
/// @throws IoError  the stream fails
void writeVdb(std::iostream& stream, const std::vector<std::shared_ptr<openvdb::GridBase>>& grids,
              const openvdb::MetaMap& fileMetadata, std::optional<Compression> compression = {});

/// @throws UsageError  the library has no such compression
void requireCompression(Compression compression);

/// Whether a file still has the content its UUID was made from.
enum class VdbContent {
  kForeign,  ///< the UUID is none of ours
  kIntact,
  kDamaged,
};
VdbContent vdbContent(std::istream& stream);

}  // namespace vox
