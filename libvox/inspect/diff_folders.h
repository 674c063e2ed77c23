#pragma once

#include "libvox/inspect/diff.h"

#include <filesystem>
#include <string>
#include <vector>

namespace vox {

/// A file of two folders, by its name.
struct FilePairDiff {
  std::string name;  ///< relative to the folder, with / between names
  bool inA = false;
  bool inB = false;
  FileDiff diff;      ///< if both folders have it
  std::string error;  ///< why the files cannot be compared; or empty
  int exitCode = 0;   ///< of this error (core/error.h)

  bool same() const { return inA && inB && error.empty() && diff.same(); }
};

struct FolderDiff {
  std::vector<FilePairDiff> files;  ///< by name

  bool same() const;
};

/// Compares all .vdb and .nvdb files of two folders and of the folders in them, by name. Links to
/// folders are not followed. A file that cannot be read is noted, and the others are compared.
/// @throws UsageError  as diffVdb
/// @throws InputError  a folder cannot be read, or has no such files, as the other; no pair has a
///   grid of `onlyGrids`
FolderDiff diffFolders(const std::filesystem::path& a, const std::filesystem::path& b,
                       DiffOptions options);

}  // namespace vox
