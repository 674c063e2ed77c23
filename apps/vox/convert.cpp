// vox convert: a mesh or scene into a .vdb file.

#include "libvox/pipeline/convert.h"

#include "apps/vox/command.h"
#include "apps/vox/options.h"
#include "libvox/core/error.h"
#include "libvox/io/input_file.h"

#include <iostream>
#include <memory>
#include <optional>
#include <sstream>

namespace vox::app {
namespace {

struct Options {
  std::string input;
  std::string output;
  ResolutionOptions resolution;
  SmoothingArguments smoothing;
  VoxelizationArguments voxelization;
  std::optional<double> weldTolerance;
  std::optional<bool> strict;
  std::string grids;
  CommonOptions common;
};

void sayInterpolation(const CommonOptions& common, const ObjectReport& object) {
  const InterpolationReport& done = object.interpolation;
  if (done.boundaryVertices + done.lift.vertices == 0) return;
  std::ostringstream text;
  text << object.name << ": interpolates " << done.boundaryVertices << " boundary and "
       << done.lift.vertices << " interior vertices, " << done.lift.iterations
       << " iterations, off by at most " << done.lift.residual << " world units";
  say(common, text.str());
}

void printReport(const Options& options, const ConvertReport& report) {
  for (const std::string& warning : report.warnings) say(options.common, "warning: " + warning);
  std::ostringstream line;
  line << options.output << ": " << report.activeVoxels << " active voxels of size "
       << report.voxelSize;
  say(options.common, line.str());
  if (!options.common.verbose) return;
  for (const ObjectReport& object : report.objects) {
    std::ostringstream text;
    text << object.name << ": " << object.inputFaces << " faces, " << object.levels << " levels, ";
    if (object.polygons.triangles > 0)
      text << object.polygons.triangles << " triangles";
    else
      text << object.submeshes << " submeshes, " << object.vertices << " vertices";
    say(options.common, text.str());
    sayInterpolation(options.common, object);
  }
  std::ostringstream times;
  times << "prepare " << report.prepareSeconds << " s, surface " << report.surfaceSeconds << " s";
  say(options.common, times.str());
}

void write(const Options& options, const Conversion& conversion) {
  if (!isStdout(options.output)) {
    writeGrids(options.output, conversion, options.common.force);
    return;
  }
  std::stringstream bytes(std::ios::in | std::ios::out | std::ios::binary);
  writeGrids(bytes, conversion);
  std::cout << bytes.view();
}

int run(const Options& options) {
  if (!isStdout(options.output) && lowerExtension(options.output) != ".vdb")
    throw UsageError(options.output + ": the output of vox convert must end in .vdb");
  ConvertOptions convertOptions;
  convertOptions.dim = options.resolution.dim;
  convertOptions.voxelSize = options.resolution.voxelSize;
  convertOptions.smoothing = parseSmoothing(options.smoothing);
  convertOptions.until = parseUntil(options.voxelization);
  convertOptions.separation = parseSeparation(options.voxelization);
  convertOptions.weldTolerance = options.weldTolerance;
  convertOptions.strict = options.strict;
  convertOptions.run = options.common.run;
  if (!options.grids.empty()) convertOptions.grids = parseGrids(options.grids);

  const Scene scene = readScene(options.input);
  requireOutput(options.output, options.common, scene);
  const Conversion conversion = convert(scene, convertOptions);
  write(options, conversion);
  printReport(options, conversion.report);
  return 0;
}

}  // namespace

Action addConvert(CLI::App& app) {
  CLI::App* command =
      app.add_subcommand("convert", "Convert a mesh or scene into a smooth voxel model (.vdb)");
  const auto options = std::make_shared<Options>();
  command->add_option("INPUT", options->input, "Scene (.toml) or mesh (.obj .ply .off .stl .om)")
      ->required();
  command->add_option("-o,--output", options->output, "OpenVDB file to write; - for stdout")
      ->required()
      ->type_name("OUT.vdb")
      ->group("Output");
  addResolutionOptions(*command, options->resolution);
  addSmoothingOptions(*command, options->smoothing);
  addVoxelizationOptions(*command, options->voxelization);
  addWeldOption(*command, options->weldTolerance);
  addStrictOption(*command, options->strict);
  command
      ->add_option(
          "--grids", options->grids,
          "Grids to write, with commas: " + allGridNames() + " (default: the scene's, or density)")
      ->type_name("LIST")
      ->group("Output");
  addCommonOptions(*command, options->common);
  return [options] { return run(*options); };
}

}  // namespace vox::app
