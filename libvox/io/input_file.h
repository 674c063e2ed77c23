#pragma once

#include <filesystem>
#include <string>

namespace vox {

/// Refuses what cannot be read to an end, before it is opened: opening a FIFO would block.
/// @throws InputError  missing, a directory, a device, or empty
void requireInputFile(const std::filesystem::path& file);

/// The whole content of a file.
/// @throws InputError  as requireInputFile, or it cannot be read
/// @throws LimitError  it is larger than the available memory
std::string contentsOf(const std::filesystem::path& file);

/// Extension with its dot, in lower case: ".obj".
std::string lowerExtension(const std::filesystem::path& file);

}  // namespace vox
