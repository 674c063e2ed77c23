#pragma once

#include <filesystem>
#include <string>

namespace vox {

/// Checks that a path is a regular file with content, without opening it: opening a FIFO would
/// block.
/// @throws InputError  it is missing, a directory, a device, or empty
void requireInputFile(const std::filesystem::path& file);

/// The whole content of a file.
/// @throws InputError  as requireInputFile, or it cannot be read
/// @throws LimitError  it is larger than the available memory
std::string contentsOf(const std::filesystem::path& file);

/// Extension with its dot, in lower case, such as ".obj".
std::string lowerExtension(const std::filesystem::path& file);

}  // namespace vox
