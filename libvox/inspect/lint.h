#pragma once

#include "libvox/grid/openvdb_fwd.h"

#include <filesystem>
#include <string>
#include <vector>

namespace vox {

/// Something that makes a viewer show a .vdb file wrongly, or not at all.
struct LintFinding {
  std::string code;     ///< short name, "no-density"
  std::string grid;     ///< name; "" for the whole file
  std::string message;  ///< the fault and its consequence
  bool isFault = true;  ///< false: a warning, of something that may be meant
};

/// A fault that lint looks for, with a short description for help.
struct LintRule {
  const char* code;
  const char* what;
};
const std::vector<LintRule>& lintRules();

/// Looks for faults (lintRules) in a .vdb file of any program: contents that Blender 3.4 or Houdini
/// will not show, or show wrongly. Leaf by leaf, in parallel.
/// @throws InputError  the file cannot be read
std::vector<LintFinding> lintVdb(const std::filesystem::path& file);

/// The same of one grid.
std::vector<LintFinding> lintGrid(const openvdb::GridBase& grid);

}  // namespace vox
