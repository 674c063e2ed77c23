// Files that belong to a mesh file: materials and images.

#include "libvox/io/companion_file.h"

#include <algorithm>
#include <string>
#include <system_error>

namespace vox {

namespace fs = std::filesystem;

fs::path companionPath(std::string_view name, const fs::path& folder) {
  const bool isWindowsRoot = name.starts_with("\\\\") || (name.size() > 1 && name[1] == ':');
  std::string path(name);
  std::replace(path.begin(), path.end(), '\\', '/');
  const std::string last = path.substr(path.find_last_of("/:") + 1);
  return folder / (isWindowsRoot && !last.empty() ? last : path);
}

fs::path foundCompanion(const fs::path& file, const fs::path& folder) {
  const fs::path beside = folder / file.filename();
  std::error_code ignored;
  return !fs::exists(file, ignored) && fs::exists(beside, ignored) ? beside : file;
}

}  // namespace vox
