#pragma once

#include <filesystem>
#include <string_view>

namespace vox {

/// The path of a file that another file names, such as an image. Backslashes become slashes. An
/// absolute path of Windows becomes its file name.
/// @param folder  of the file that names it
std::filesystem::path companionPath(std::string_view name, const std::filesystem::path& folder);

/// A file at its path; or, if it is missing there, beside the file that names it.
std::filesystem::path foundCompanion(const std::filesystem::path& file,
                                     const std::filesystem::path& folder);

}  // namespace vox
