#pragma once

#include "apps/vox/command.h"
#include "libvox/inspect/diff.h"

#include <string>

namespace vox::app {

/// Arguments of vox diff, as typed.
struct DiffArguments {
  std::string a, b;
  DiffOptions diff;
  std::string grids;
  bool noMetadata = false;
  std::string output;
  std::string junit;
  std::string report;
  bool force = false;
  bool quiet = false;
  bool json = false;
};
void declareDiff(CLI::App& app, DiffArguments& options);

/// What --json prints. Writes the files that the arguments ask for.
/// @throws UsageError, InputError, IoError, LimitError
std::string diffJson(const DiffArguments& options);

}  // namespace vox::app
