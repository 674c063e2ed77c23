// vox subdivide: the refined polygon mesh itself.

#include "apps/vox/command.h"
#include "apps/vox/interrupt.h"
#include "apps/vox/options.h"
#include "apps/vox/progress_bar.h"
#include "libvox/core/progress.h"
#include "libvox/io/atomic_file.h"
#include "libvox/io/watched_stream.h"
#include "libvox/io/write_mesh.h"
#include "libvox/pipeline/refine.h"

#include <iostream>
#include <memory>
#include <optional>

namespace vox::app {
namespace {

struct SubdivideArguments {
  std::string input;
  std::string output;
  int levels = 0;
  SmoothingArguments smoothing;
  std::optional<double> weldTolerance;
  std::optional<ComponentLimit> dropComponents;
  std::optional<bool> strict;
  CommonOptions common;
};

/// Bytes of a file, roughly: OBJ is the longest.
std::uint64_t expectedBytes(const PolygonMesh& mesh) {
  constexpr std::uint64_t kPerPoint = 55;
  constexpr std::uint64_t kPerCorner = 8;
  return kPerPoint * mesh.pointCount() + kPerCorner * mesh.cornerCount();
}

void write(const SubdivideArguments& options, const PolygonMesh& mesh, Progress& progress) {
  progress.beginLast("write");
  if (isStdout(options.output)) {
    WatchedStream stream(*std::cout.rdbuf(), progress, expectedBytes(mesh));
    writeMesh(stream, mesh, MeshFormat::kObj);
    return;
  }
  AtomicFile output(options.output, options.common.force);
  WatchedStream stream(*output.stream().rdbuf(), progress, expectedBytes(mesh));
  writeMesh(stream, mesh, meshFormatFor(options.output));
  progress.check();
  output.commit();
}

int runSubdivide(const SubdivideArguments& options) {
  if (!isStdout(options.output)) meshFormatFor(options.output);
  const PreparationOptions preparation = {parseSmoothing(options.smoothing), options.weldTolerance,
                                          options.dropComponents, options.strict};
  ProgressBar bar(!options.common.quiet);
  const Scene scene = readScene(options.input);
  requireOutput(options.output, options.common, scene);
  Progress progress(bar.callback());
  RunOptions runOptions = options.common.run;
  runOptions.progress = &progress;
  Refinement refined;
  {
    const CancelOnSignal cancelOnSignal(progress);
    refined = refine(scene, options.levels, preparation, runOptions);
    write(options, refined.mesh, progress);
    progress.finish();
  }
  bar.erase();
  const PolygonMesh& mesh = refined.mesh;
  for (const std::string& warning : refined.warnings) say(options.common, "warning: " + warning);
  say(options.common, options.output + ": " + std::to_string(mesh.pointCount()) + " vertices, " +
                          std::to_string(mesh.faceCount()) + " faces");
  return 0;
}

}  // namespace

Action addSubdivide(CLI::App& app) {
  const Command command(app, "subdivide", "Write the refined polygon mesh itself");
  const auto options = std::make_shared<SubdivideArguments>();
  command.add("INPUT", options->input, "Scene (.toml) or mesh (.obj .ply .off .stl .om)")
      .required();
  command
      .add("-o,--output", options->output,
           "Mesh file to write: .obj, .ply or .off; - for OBJ on stdout")
      .required()
      .type("OUT")
      .group("Output");
  constexpr int kMostLevels = 30;
  command
      .add("--levels", options->levels,
           "Doo-Sabin steps; 0 writes the control mesh: the input with its vertices moved where "
           "--interpolate asks for it")
      .required()
      .range(0, kMostLevels)
      .type("K")
      .group("Output");
  addSmoothingOptions(command, options->smoothing);
  addWeldOption(command, options->weldTolerance);
  addDropOption(command, options->dropComponents);
  addStrictOption(command, options->strict);
  addCommonOptions(command, options->common);
  return [options] { return runSubdivide(*options); };
}

}  // namespace vox::app
