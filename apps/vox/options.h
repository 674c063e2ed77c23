#pragma once

#include "libvox/grid/grid_kind.h"

#include <CLI/CLI.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace vox::app {

/// Options that several subcommands share.
struct RunOptions {
  int threads = 0;
  std::uint64_t maxMemory = 0;
  bool force = false;
  bool quiet = false;
  bool verbose = false;
};
void addRunOptions(CLI::App& command, RunOptions& run);

/// --dim and --voxel-size.
struct ResolutionOptions {
  std::optional<int> dim;
  std::optional<double> voxelSize;
};
void addResolutionOptions(CLI::App& command, ResolutionOptions& resolution);

/// "density,mask" as grids.
/// @throws UsageError  an unknown name
std::vector<GridKind> parseGrids(const std::vector<std::string>& names);

/// "-": data goes to standard output.
bool isStdout(const std::string& file);

}  // namespace vox::app
