#pragma once

#include "apps/vox/json.h"
#include "libvox/inspect/diff.h"
#include "libvox/inspect/diff_folders.h"

#include <string>

namespace vox::app {

// What vox diff says of differences, as lines for people and as JSON.

std::string textOf(const GridDiff& grid);
std::string textOf(const FileDiff& diff);
std::string textOf(const FilePairDiff& file);
std::string textOf(const FolderDiff& diff);

/// Differences of the metadata of a file; empty if there are none.
std::string textOfMetadata(const FileDiff& diff);

/// @param a, b  names of the files or folders
Json jsonOf(const FileDiff& diff, const std::string& a, const std::string& b);
Json jsonOf(const FolderDiff& diff, const std::string& a, const std::string& b);

}  // namespace vox::app
