// vox subdivide: the refined polygon mesh itself.

#include "apps/vox/command.h"
#include "apps/vox/interrupt.h"
#include "apps/vox/options.h"
#include "apps/vox/progress_bar.h"
#include "libvox/core/parallel.h"
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
  std::optional<double> scale;
  std::optional<double> weldTolerance;
  std::optional<ComponentLimit> dropComponents;
  std::optional<bool> strict;
  CommonOptions common;
};

/// Bytes of a file, roughly: OBJ is the longest.
std::uint64_t expectedBytes(const PolygonMesh& mesh) {
  constexpr std::uint64_t kPerPoint = 55;
  constexpr std::uint64_t kPerCorner = 8;
  constexpr std::uint64_t kPerColor = 33;
  return kPerPoint * mesh.pointCount() + kPerCorner * mesh.cornerCount() +
         kPerColor * (mesh.pointColors.size() + mesh.faceColors.size());
}

MeshFormat formatOf(const std::string& output) {
  return isStdout(output) ? MeshFormat::kObj : meshFormatFor(output);
}

/// Warns of colours that the file does not get.
void sayLostColors(const SubdivideArguments& options, const Scene& scene, const PolygonMesh& mesh) {
  if (formatOf(options.output) == MeshFormat::kObj && !mesh.faceColors.empty())
    say(options.common,
        "warning: OBJ has no colours of faces, so they are dropped; .ply and .off keep them");
  for (const SceneObject& object : scene.objects)
    if (object.texture)
      return say(options.common,
                 "warning: textures are not written: a mesh file has no place for them");
}

void write(const SubdivideArguments& options, const PolygonMesh& mesh, Progress& progress) {
  progress.beginLast("write");
  if (isStdout(options.output)) {
    WatchedStream stream(*std::cout.rdbuf(), progress, expectedBytes(mesh));
    writeMesh(stream, mesh, formatOf(options.output));
    return;
  }
  AtomicFile output(options.output, options.common.force);
  WatchedStream stream(*output.stream().rdbuf(), progress, expectedBytes(mesh));
  writeMesh(stream, mesh, formatOf(options.output));
  progress.check();
  output.commit();
}

int runSubdivide(const SubdivideArguments& options) {
  formatOf(options.output);  // refuses others
  const PreparationOptions preparation = {parseSmoothing(options.smoothing), options.weldTolerance,
                                          options.dropComponents, options.strict};
  ProgressBar bar(options.common);
  const Scene scene = onThreads(options.common.run.threads,
                                [&] { return readScene(options.input, options.scale); });
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
  sayLostColors(options, scene, mesh);
  say(options.common, options.output + ": " + std::to_string(mesh.pointCount()) + " vertices, " +
                          std::to_string(mesh.faceCount()) + " faces");
  return 0;
}

}  // namespace

Action addSubdivide(CLI::App& app) {
  const Command command(app, "subdivide", "Write the refined polygon mesh itself");
  const auto options = std::make_shared<SubdivideArguments>();
  command.add("INPUT", options->input, "Scene (.toml) or mesh (.obj .ply .off .stl .om .gltf .glb)")
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
           "Doo-Sabin steps; 0 writes the control mesh: the input as it is smoothed, with faces "
           "split (--faces) and vertices moved (--interpolate)")
      .required()
      .range(0, kMostLevels)
      .type("K")
      .group("Output");
  addSmoothingOptions(command, options->smoothing);
  addScaleOption(command, options->scale);
  addWeldOption(command, options->weldTolerance);
  addDropOption(command, options->dropComponents);
  addStrictOption(command, options->strict);
  addProgressOption(command, options->common);
  addCommonOptions(command, options->common);
  return [options] { return runSubdivide(*options); };
}

}  // namespace vox::app
