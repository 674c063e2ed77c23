#pragma once

#include "libvox/grid/openvdb_fwd.h"
#include "libvox/options/volume_options.h"

#include <iosfwd>
#include <memory>
#include <optional>
#include <vector>

namespace vox {

/// Writes grids in OpenVDB's file format, without the values of inactive voxels. A hash of
/// everything else in the file replaces its random UUID, so that equal grids and metadata give
/// equal bytes. Works on all threads of the caller's arena.
///
/// @param stream       empty, readable, writable and seekable: std::fstream, std::stringstream
/// @param compression  default: the first of Blosc, zip and none that the OpenVDB library has
/// @throws IoError  the stream fails
void writeVdb(std::iostream& stream, const std::vector<std::shared_ptr<openvdb::GridBase>>& grids,
              const openvdb::MetaMap& fileMetadata, std::optional<Compression> compression = {});

/// The last step of writeVdb, for whoever writes the rest of a file in another way: replaces the
/// random UUID by the hash, and flushes.
/// @throws IoError  the stream fails
void nameByContent(std::iostream& stream);

/// Checks that the OpenVDB library has a compression.
/// @throws UsageError  it does not
void requireCompression(Compression compression);

/// Whether a .vdb file from writeVdb still has the content from which its UUID was made.
enum class VdbContent {
  kForeign,  ///< the UUID shows that writeVdb did not write the file
  kIntact,
  kDamaged,
};

/// Compares the UUID of a file with its content. Reads the whole file if writeVdb wrote it.
VdbContent vdbContent(std::istream& stream);

}  // namespace vox
