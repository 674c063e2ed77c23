#pragma once

#include "apps/vox/command.h"
#include "apps/vox/options.h"
#include "libvox/pipeline/convert.h"

#include <string>
#include <vector>

namespace vox::app {

/// Arguments of vox convert, as typed.
struct ConvertArguments {
  std::vector<std::string> inputs;
  std::string output;
  ConversionArguments conversion;
  std::string grids;
  std::string part;
  PartArguments parts;
  VolumeArguments volume;
  std::string report;
  bool verify = false;
  bool dryRun = false;
  CommonOptions common;
  std::vector<Option> meshOptions;  ///< those that files of grids do not have
};
void declareConvert(CLI::App& app, ConvertArguments& options);

/// Their values; reads the files of vertices and edges.
/// @throws UsageError, InputError
ConvertOptions parseConvert(const ConvertArguments& options);

/// @param isPart  the grids are those of --part
/// @param isHalf  their floats have 16 bits
/// @throws UsageError  the output is a NanoVDB file, which cannot hold that
void requireHeld(const std::string& output, bool isPart, bool isHalf);

/// Converts a scene and, if asked for, verifies the result. A scene that is moved may be used up.
/// @throws CheckFailed  the result has a fault; and all that convert throws
Conversion convertScene(const Scene& scene, const Request& request, bool verified);
Conversion convertScene(Scene&& scene, const Request& request, bool verified);

}  // namespace vox::app
