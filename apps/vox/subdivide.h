#pragma once

#include "apps/vox/command.h"
#include "apps/vox/options.h"

#include <optional>
#include <string>

namespace vox::app {

/// Arguments of vox subdivide, as typed.
struct SubdivideArguments {
  std::string input;
  std::string output;
  int levels = 0;
  SmoothingArguments smoothing;
  std::optional<double> scale;
  std::optional<double> weldTolerance;
  std::optional<ComponentLimit> dropComponents;
  std::optional<bool> strict;
  CommonOptions common;
};
void declareSubdivide(CLI::App& app, SubdivideArguments& options);

/// Their values; reads the files of vertices and edges.
/// @throws UsageError, InputError
PreparationOptions parsePreparation(const SubdivideArguments& options);

}  // namespace vox::app
