#pragma once

#include "apps/vox/command.h"
#include "apps/vox/options.h"

#include <optional>
#include <string>
#include <vector>

namespace vox::app {

/// Arguments of vox info, as typed.
struct InfoArguments {
  std::vector<std::string> files;
  bool json = false;
  std::optional<double> scale;
  std::optional<double> weldTolerance;
  std::string boundary;
  std::string faces;
  CreaseArguments creases;
  std::optional<ComponentLimit> dropComponents;
};
void declareInfo(CLI::App& app, InfoArguments& options);

/// What --json prints of the first file.
/// @param input  the scene that is described in place of the file; or null
/// @throws UsageError, InputError, LimitError
std::string infoJson(const InfoArguments& options, const Scene* input = nullptr);

}  // namespace vox::app
