// Comparison of whole folders.

#include "libvox/inspect/diff_folders.h"

#include "libvox/core/error.h"
#include "libvox/inspect/compared.h"
#include "libvox/io/grid_file.h"

#include <algorithm>
#include <map>
#include <system_error>

namespace vox {
namespace {

namespace fs = std::filesystem;

/// The files of grids in a folder: their names, relative to it.
std::vector<std::string> gridFilesIn(const fs::path& folder) {
  std::vector<std::string> names;
  try {
    for (const fs::directory_entry& entry : fs::recursive_directory_iterator(folder))
      if (isGridFile(entry.path()) && !entry.is_directory())
        names.push_back(entry.path().lexically_relative(folder).generic_string());
  } catch (const fs::filesystem_error& error) {
    throw InputError(error.path1().string() + ": cannot be read: " + error.code().message());
  }
  return names;
}

void comparePair(const fs::path& a, const fs::path& b, const DiffOptions& options,
                 FilePairDiff& file) {
  try {
    file.diff = diffVdb(a / file.name, b / file.name, options);
  } catch (const Error& error) {
    file.error = error.what();
    file.exitCode = error.exitCode();
  }
}

/// Checks that some file has each grid that was asked for.
void requireGrids(const FolderDiff& all, const DiffOptions& options) {
  for (const std::string& name : options.onlyGrids) {
    const bool found =
        std::any_of(all.files.begin(), all.files.end(), [&](const FilePairDiff& file) {
          return !file.error.empty() ||
                 std::any_of(file.diff.grids.begin(), file.diff.grids.end(),
                             [&](const GridDiff& grid) { return grid.name == name; });
        });
    if (!found) throw InputError("no file that both folders have has a grid '" + name + "'");
  }
}

}  // namespace

bool FolderDiff::same() const {
  return std::all_of(files.begin(), files.end(),
                     [](const FilePairDiff& file) { return file.same(); });
}

FolderDiff diffFolders(const fs::path& a, const fs::path& b, DiffOptions options) {
  const Tolerance checked(options);
  options.gridsMayLack = true;
  std::map<std::string, FilePairDiff> byName;
  for (const std::string& name : gridFilesIn(a)) byName[name].inA = true;
  for (const std::string& name : gridFilesIn(b)) byName[name].inB = true;
  if (byName.empty())
    throw InputError(a.string() + ", " + b.string() + ": neither folder has .vdb or .nvdb files");
  FolderDiff all;
  for (auto& [name, file] : byName) {
    file.name = name;
    if (file.inA && file.inB) comparePair(a, b, options, file);
    all.files.push_back(std::move(file));
  }
  requireGrids(all, options);
  return all;
}

}  // namespace vox
