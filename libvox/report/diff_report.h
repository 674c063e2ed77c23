#pragma once

#include "libvox/inspect/diff_folders.h"

#include <string>
#include <vector>

namespace vox {

/// What was compared with what.
struct Comparison {
  std::string a, b;         ///< files or folders, as typed
  bool areFolders = false;  ///< then files lie below them, by their names
  DiffOptions options;
  std::vector<FilePairDiff> files;
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
