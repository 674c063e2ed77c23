#pragma once

#include "libvox/grid/openvdb_fwd.h"
#include "libvox/options/volume_options.h"

#include <iosfwd>
#include <memory>
#include <optional>
#include <vector>

namespace vox {

/// Writes grids in NanoVDB's file format, each with its name, class, transform, all values, the
/// extremes of each node and checksums of everything. The format has no other metadata. Equal grids
/// give equal bytes. One grid at a time is in memory twice. Works on all threads of the caller's
/// arena.
///
/// @param stream       empty, writable and seekable beyond its end: std::fstream
/// @param grids        no other thread may use them; NanoVDB notes places in their nodes meanwhile
/// @param compression  default: Blosc
/// @throws InputError  NanoVDB has no such type or transform
/// @throws IoError     the stream fails
void writeNvdb(std::iostream& stream, const std::vector<std::shared_ptr<openvdb::GridBase>>& grids,
               std::optional<Compression> compression = {});

}  // namespace vox
