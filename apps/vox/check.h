#pragma once

#include "apps/vox/command.h"
#include "apps/vox/options.h"

#include <optional>
#include <string>

namespace vox::app {

/// Arguments of vox check, as typed.
struct CheckArguments {
  std::string file;
  std::string mesh;
  std::string grid;
  std::string ignore;
  SmoothingArguments smoothing;
  std::string until;
  std::optional<double> weldTolerance;
  RunOptions run;
  std::string report;
  bool force = false;
  bool quiet = false;
  bool json = false;
};
void declareCheck(CLI::App& app, CheckArguments& options);

/// What --json prints. Writes the file of --report.
/// @param input  the scene that stands for the file of --mesh, which must be given; or null
/// @throws UsageError, InputError, IoError, LimitError
std::string checkJson(const CheckArguments& options, const Scene* input = nullptr);

}  // namespace vox::app
