// vox subdivide: the refined polygon mesh itself.

#include "apps/vox/command.h"
#include "apps/vox/options.h"
#include "libvox/core/error.h"
#include "libvox/io/atomic_file.h"
#include "libvox/io/scene_file.h"
#include "libvox/io/write_mesh.h"
#include "libvox/pipeline/convert.h"

#include <cstdio>
#include <iostream>
#include <memory>

namespace vox::app {
namespace {

struct Options {
  std::string input;
  std::string output;
  int levels = 0;
  RunOptions run;
};

void write(const Options& options, const PolygonMesh& mesh) {
  if (isStdout(options.output)) {
    writeMesh(std::cout, mesh, MeshFormat::kObj);
    std::cout.flush();
    if (!std::cout) throw IoError("standard output cannot be written");
    return;
  }
  AtomicFile output(options.output, options.run.force);
  writeMesh(output.stream(), mesh, meshFormatFor(options.output));
  output.commit();
}

int run(const Options& options) {
  if (!isStdout(options.output)) {
    meshFormatFor(options.output);
    requireWritable(options.output, options.run.force);
  }
  ConvertOptions convertOptions;
  convertOptions.maxMemory = options.run.maxMemory;
  convertOptions.threads = options.run.threads;
  const PolygonMesh mesh = refine(readScene(options.input), options.levels, convertOptions);
  write(options, mesh);
  if (!options.run.quiet)
    std::fprintf(stderr, "vox: %s: %u points, %u faces\n", options.output.c_str(),
                 mesh.pointCount(), mesh.faceCount());
  return 0;
}

}  // namespace

Action addSubdivide(CLI::App& app) {
  CLI::App* command = app.add_subcommand("subdivide", "Write the refined polygon mesh itself");
  const auto options = std::make_shared<Options>();
  command->add_option("INPUT", options->input, "Scene (.toml) or mesh (.obj .ply .off .stl .om)")
      ->required();
  command
      ->add_option("-o,--output", options->output,
                   "Mesh file to write: .obj, .ply or .off; - for OBJ on stdout")
      ->required()
      ->type_name("OUT");
  constexpr int kMostLevels = 30;
  command
      ->add_option("--levels", options->levels, "Doo-Sabin steps; 0 writes the mesh as it was read")
      ->required()
      ->check(CLI::Range(0, kMostLevels))
      ->type_name("K");
  addRunOptions(*command, options->run);
  return [options] { return run(*options); };
}

}  // namespace vox::app
