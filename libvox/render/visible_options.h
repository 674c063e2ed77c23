#pragma once

#include <optional>
#include <string>

namespace vox {

/// What to show of the grids of a file.
struct VisibleOptions {
  std::string grid;                 ///< name of the grid; empty: chosen as visibleGrids() tells
  std::optional<double> threshold;  ///< fog above it is solid; default: a tenth of the largest
};

}  // namespace vox
