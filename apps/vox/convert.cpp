// vox convert: a mesh or scene into a .vdb file.

#include "libvox/pipeline/convert.h"

#include "apps/vox/command.h"
#include "apps/vox/options.h"
#include "libvox/core/error.h"
#include "libvox/io/atomic_file.h"
#include "libvox/io/scene_file.h"

#include <cstdio>
#include <iostream>
#include <memory>
#include <sstream>

namespace vox::app {
namespace {

struct Options {
  std::string input;
  std::string output;
  ResolutionOptions resolution;
  std::vector<std::string> grids;
  RunOptions run;
};

void printObjects(const ConvertReport& report) {
  for (const ObjectReport& object : report.objects)
    std::fprintf(stderr, "  %s: %llu faces, %d levels, %llu vertices, largest face %.3f voxels\n",
                 object.name.c_str(), static_cast<unsigned long long>(object.inputFaces),
                 object.levels, static_cast<unsigned long long>(object.vertices),
                 object.largestSpan);
  std::fprintf(stderr, "  subdivide %.3f s, voxelize %.3f s\n", report.subdivideSeconds,
               report.voxelizeSeconds);
}

void write(const Options& options, const Conversion& conversion) {
  if (!isStdout(options.output)) {
    writeGrids(options.output, conversion, options.run.force);
    return;
  }
  std::stringstream bytes(std::ios::in | std::ios::out | std::ios::binary);
  writeGrids(bytes, conversion);
  std::cout << bytes.view() << std::flush;
  if (!std::cout) throw IoError("standard output cannot be written");
}

int run(const Options& options) {
  if (!isStdout(options.output)) requireWritable(options.output, options.run.force);
  ConvertOptions convertOptions;
  convertOptions.dim = options.resolution.dim;
  convertOptions.voxelSize = options.resolution.voxelSize;
  if (!options.grids.empty()) convertOptions.grids = parseGrids(options.grids);
  convertOptions.maxMemory = options.run.maxMemory;
  convertOptions.threads = options.run.threads;

  const Conversion conversion = convert(readScene(options.input), convertOptions);
  write(options, conversion);

  const ConvertReport& report = conversion.report;
  if (options.run.quiet) return 0;
  std::fprintf(stderr, "vox: %s: %llu active voxels of size %g\n", options.output.c_str(),
               static_cast<unsigned long long>(report.activeVoxels), report.voxelSize);
  if (options.run.verbose) printObjects(report);
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
      ->type_name("OUT.vdb");
  addResolutionOptions(*command, options->resolution);
  command
      ->add_option("--grids", options->grids,
                   "Grids to write: " + allGridNames() + " (default: the scene's, or density)")
      ->delimiter(',')
      ->allow_extra_args(false)
      ->type_name("LIST")
      ->group("Output");
  addRunOptions(*command, options->run);
  return [options] { return run(*options); };
}

}  // namespace vox::app
