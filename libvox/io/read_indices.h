#pragma once

#include "libvox/core/types.h"

#include <filesystem>
#include <vector>

namespace vox {

/// Reads a text file of 0-based indices, separated by blanks and line ends; # starts a comment.
/// @throws InputError  the file is unreadable, or a token is not an index; the message names file
///   and line
std::vector<Index> readIndices(const std::filesystem::path& file);

/// Reads such a file of pairs.
/// @throws InputError  besides, the last pair lacks a partner
std::vector<PointPair> readIndexPairs(const std::filesystem::path& file);

}  // namespace vox
