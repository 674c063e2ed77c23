#pragma once

#include "libvox/options/volume_options.h"

#include <optional>
#include <string>

namespace vox::app {

struct CommonOptions;

/// Writes the grids of a .vdb or .nvdb file to another one, in the format of its name.
/// @param output  - for stdout, as .vdb
/// @throws InputError, UsageError, IoError
void copyGrids(const std::string& input, const std::string& output,
               std::optional<Compression> compression, const CommonOptions& common);

}  // namespace vox::app
