// vox subdivide: the refined polygon mesh itself.

#include "apps/vox/subdivide.h"

#include "apps/vox/interrupt.h"
#include "apps/vox/progress_bar.h"
#include "libvox/core/parallel.h"
#include "libvox/core/progress.h"
#include "libvox/io/atomic_file.h"
#include "libvox/io/input_file.h"
#include "libvox/io/watched_stream.h"
#include "libvox/io/write_glb.h"
#include "libvox/io/write_mesh.h"
#include "libvox/pipeline/refine.h"
#include "libvox/pipeline/shaded_refinement.h"

#include <algorithm>
#include <iostream>
#include <memory>
#include <string>
#include <vector>

namespace vox::app {
namespace {

/// Bytes of a file, roughly: OBJ is the longest.
std::uint64_t expectedBytes(const PolygonMesh& mesh) {
  constexpr std::uint64_t kPerPoint = 55;
  constexpr std::uint64_t kPerCorner = 8;
  constexpr std::uint64_t kPerColor = 33;
  return kPerPoint * mesh.pointCount() + kPerCorner * mesh.cornerCount() +
         kPerColor * (mesh.pointColors.size() + mesh.faceColors.size());
}

bool isGlb(const std::string& output) {
  return lowerExtension(output) == ".glb";
}

MeshFormat formatOf(const std::string& output) {
  return isStdout(output) ? MeshFormat::kObj : meshFormatFor(output);
}

/// Warns of colours that the file does not get.
void noteLostColors(const SubdivideArguments& options, const Scene& scene, Refinement& refined) {
  if (formatOf(options.output) == MeshFormat::kObj && !refined.mesh.faceColors.empty())
    refined.warnings.emplace_back(
        "OBJ has no colours of faces, so they are dropped; .ply, .off and .glb keep them");
  const bool hasTexture =
      std::any_of(scene.objects.begin(), scene.objects.end(),
                  [](const SceneObject& object) { return object.texture.has_value(); });
  if (hasTexture)
    refined.warnings.emplace_back(
        "textures are not written: the format has no place for them; .glb keeps them");
}

/// Calls writeTo(stream) with the stream of the output.
template <class WriteTo>
void write(const SubdivideArguments& options, std::uint64_t bytes, Progress& progress,
           WriteTo&& writeTo) {
  progress.beginLast("write");
  if (isStdout(options.output)) {
    WatchedStream stream(*std::cout.rdbuf(), progress, bytes);
    writeTo(stream);
    return;
  }
  AtomicFile output(options.output, options.common.force);
  WatchedStream stream(*output.stream().rdbuf(), progress, bytes);
  writeTo(stream);
  progress.check();
  output.commit();
}

/// What was written, for messages.
struct Written {
  std::uint64_t vertices = 0, faces = 0;
  std::vector<std::string> warnings;
};

Written writeShaded(const SubdivideArguments& options, const Scene& scene,
                    const PreparationOptions& preparation, const RunOptions& run) {
  const ShadedRefinement refined = shadedRefinement(scene, options.levels, preparation, run);
  write(options, glbBytes(refined.scene), *run.progress,
        [&](std::ostream& out) { writeGlb(out, refined.scene); });
  return {refined.vertexCount, refined.triangleCount, refined.warnings};
}

Written writePolygons(const SubdivideArguments& options, const Scene& scene,
                      const PreparationOptions& preparation, const RunOptions& run) {
  Refinement refined = refine(scene, options.levels, preparation, run);
  write(options, expectedBytes(refined.mesh), *run.progress,
        [&](std::ostream& out) { writeMesh(out, refined.mesh, formatOf(options.output)); });
  noteLostColors(options, scene, refined);
  return {refined.mesh.pointCount(), refined.mesh.faceCount(), refined.warnings};
}

int runSubdivide(const SubdivideArguments& options) {
  if (!isGlb(options.output)) formatOf(options.output);  // refuses others
  const PreparationOptions preparation = parsePreparation(options);
  ProgressBar bar(options.common);
  const Scene scene = onThreads(options.common.run.threads,
                                [&] { return readScene(options.input, options.scale); });
  requireOutput(options.output, options.common, scene);
  Progress progress(bar.callback());
  RunOptions run = options.common.run;
  run.progress = &progress;
  Written written;
  {
    const CancelOnSignal cancelOnSignal(progress);
    written =
        (isGlb(options.output) ? writeShaded : writePolygons)(options, scene, preparation, run);
    progress.finish();
  }
  bar.erase();
  for (const std::string& warning : written.warnings) say(options.common, "warning: " + warning);
  say(options.common, options.output + ": " + std::to_string(written.vertices) + " vertices, " +
                          std::to_string(written.faces) +
                          (isGlb(options.output) ? " triangles" : " faces"));
  return 0;
}

}  // namespace

PreparationOptions parsePreparation(const SubdivideArguments& options) {
  return {parseSmoothing(options.smoothing), options.weldTolerance, options.dropComponents,
          options.strict};
}

void declareSubdivide(CLI::App& app, SubdivideArguments& options) {
  const Command command(app, "subdivide", "Write the refined polygon mesh itself");
  command.add("INPUT", options.input, "Scene (.toml) or mesh (.obj .ply .off .stl .om .gltf .glb)")
      .required();
  command
      .add(
          "-o,--output", options.output,
          "Mesh file to write: .obj, .ply or .off, or .glb for triangles with normals, colours and "
          "materials; - for OBJ on stdout")
      .required()
      .type("OUT")
      .group("Output");
  constexpr int kMostLevels = 30;
  command
      .add("--levels", options.levels,
           "Doo-Sabin steps; 0 writes the control mesh: the input as it is smoothed, with faces "
           "split (--faces) and vertices moved (--interpolate)")
      .required()
      .range(0, kMostLevels)
      .type("K")
      .group("Output");
  addSmoothingOptions(command, options.smoothing);
  addScaleOption(command, options.scale);
  addWeldOption(command, options.weldTolerance);
  addDropOption(command, options.dropComponents);
  addStrictOption(command, options.strict);
  addProgressOption(command, options.common);
  addCommonOptions(command, options.common);
}

Action addSubdivide(CLI::App& app) {
  const auto options = std::make_shared<SubdivideArguments>();
  declareSubdivide(app, *options);
  return [options] { return runSubdivide(*options); };
}

}  // namespace vox::app
