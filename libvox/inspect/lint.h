#pragma once

#include "libvox/grid/openvdb_fwd.h"

#include <filesystem>
#include <string>
#include <vector>

namespace vox {

/// Something a viewer of a .vdb file will trip over.
struct LintFinding {
  std::string code;     ///< "no-density": to choose by
  std::string grid;     ///< name; "" for the whole file
  std::string message;  ///< what is wrong, and what comes of it
};

/// What lint can say, and in short what of: for help.
struct LintRule {
  const char* code;
  const char* what;
};
const std::vector<LintRule>& lintRules();

/// Looks for what Blender 3.4 or Houdini will not show, or not as meant, in a .vdb file of any
/// program: see lintRules. Leaf by leaf, in parallel.
/// @throws InputError  the file cannot be read
std::vector<LintFinding> lintVdb(const std::filesystem::path& file);

/// The same of one grid.
std::vector<LintFinding> lintGrid(const openvdb::GridBase& grid);

}  // namespace vox
