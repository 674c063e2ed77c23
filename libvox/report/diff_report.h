#pragma once

#include "libvox/inspect/diff.h"

#include <filesystem>
#include <string>
#include <vector>

namespace vox {

/// Two files of a name, and what differs.
struct ComparedFiles {
  std::string name;
  std::filesystem::path a, b;  ///< empty: there is no such file
  FileDiff diff;               ///< of both

  bool same() const { return !a.empty() && !b.empty() && diff.same(); }
};

/// What was compared with what.
struct Comparison {
  std::string a, b;  ///< files or folders, as typed
  DiffOptions options;
  std::vector<ComparedFiles> files;
  std::vector<std::string> command;  ///< words that make the same comparison

  bool same() const;
};

/// A page of HTML for people to see what differs. It stands alone and has less than 2 MB: text of
/// all files; pictures, a histogram and a view that turns of what differs, of as many grids as fit.
/// The same comparison gives the same bytes.
/// @throws InputError  a file cannot be read again
/// @throws LimitError  a difference does not fit into memory
std::string diffReport(const Comparison& comparison);

}  // namespace vox
