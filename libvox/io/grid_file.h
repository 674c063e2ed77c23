#pragma once

#include "libvox/grid/openvdb_fwd.h"
#include "libvox/options/volume_options.h"

#include <filesystem>
#include <iosfwd>
#include <memory>
#include <optional>
#include <vector>

namespace vox {

/// Whether a name is that of a file of grids: .vdb, or .nvdb for NanoVDB. readVdb reads both.
bool isGridFile(const std::filesystem::path& file);

/// Whether a name is that of a NanoVDB file, which holds no metadata.
bool isNvdb(const std::filesystem::path& file);

/// Writes the content of a file of this name: NanoVDB's format for .nvdb, otherwise OpenVDB's.
/// @param stream  as writeVdb and writeNvdb want it: std::fstream
/// @throws IoError, InputError  as these
void writeGridFile(std::iostream& stream, const std::filesystem::path& name,
                   const std::vector<std::shared_ptr<openvdb::GridBase>>& grids,
                   const openvdb::MetaMap& fileMetadata,
                   std::optional<Compression> compression = {});

}  // namespace vox
