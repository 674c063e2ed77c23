// vox convert: a mesh or scene into a file of grids, or such a file into another format.

#include "apps/vox/convert.h"

#include "apps/vox/convert_report.h"
#include "apps/vox/copy_grids.h"
#include "apps/vox/counted.h"
#include "apps/vox/interrupt.h"
#include "apps/vox/progress_bar.h"
#include "apps/vox/sequence.h"
#include "apps/vox/verify.h"
#include "libvox/core/error.h"
#include "libvox/core/memory.h"
#include "libvox/core/parallel.h"
#include "libvox/core/progress.h"
#include "libvox/core/stopwatch.h"
#include "libvox/grid/transform.h"
#include "libvox/io/atomic_file.h"
#include "libvox/io/grid_file.h"
#include "libvox/io/input_file.h"
#include "libvox/pipeline/refine.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iomanip>
#include <iostream>
#include <memory>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace vox::app {
namespace {

void sayReport(const ConvertArguments& options, const FinishedRun& run) {
  const ConvertReport& report = run.conversion.report;
  for (const std::string& warning : report.warnings) say(options.common, "warning: " + warning);
  std::ostringstream line;
  line << run.output << ": " << report.activeVoxels << " active voxels of size "
       << report.voxelSize;
  say(options.common, line.str());
  if (!options.common.verbose) return;
  for (const std::string& more : reportLines(run)) say(options.common, more);
}

void write(const ConvertArguments& options, const std::string& output, const Conversion& conversion,
           Progress& progress) {
  if (!isStdout(output)) {
    writeGrids(output, conversion, options.common.force, &progress);
    return;
  }
  std::stringstream bytes(std::ios::in | std::ios::out | std::ios::binary);
  writeGrids(bytes, conversion, &progress);
  std::cout << bytes.view();
}

void writeReport(const ConvertArguments& options, const FinishedRun& run) {
  AtomicFile file(options.report, options.common.force);
  file.stream() << reportJson(run);
  file.commit();
}

/// An estimate with three digits: "about 270000".
std::string about(double count) {
  const double unit =
      std::pow(10.0, std::max(0.0, std::floor(std::log10(std::max(count, 1.0))) - 2));
  std::ostringstream text;
  text << std::fixed << std::setprecision(0) << "about " << std::round(count / unit) * unit;
  return text.str();
}

/// Prints what a conversion would make.
void printEstimate(const ConvertArguments& options, const Scene& scene, const Request& request) {
  std::vector<std::string> warnings;
  const Estimate made = estimate(scene, request, warnings);
  for (const std::string& warning : warnings) say(options.common, "warning: " + warning);
  if (!made.refusal.empty()) throw LimitError(made.refusal);
  const auto bytes = [](double count) { return formatBytes(static_cast<std::uint64_t>(count)); };
  std::cout << "voxel size " << made.voxelSize << ", " << made.levels << " levels";
  if (made.voxels > 0) std::cout << ", " << about(made.voxels) << " voxels of the surface";
  std::cout << '\n';
  for (const GridEstimate& grid : made.grids)
    std::cout << "grid " << nameIn(kGridNames, grid.kind) << ": " << about(grid.voxels)
              << " voxels in " << about(grid.leaves) << " leaves, " << bytes(grid.bytes)
              << " in memory, " << bytes(grid.fileBytes) << " in the file\n";
  std::cout << "in all: about " << bytes(made.bytes) << " of memory for grids, "
            << bytes(made.fileBytes) << " in the file\n";
  for (std::size_t i = 0; i < made.shares.size(); ++i)
    std::cout << "part " << i + 1 << " of " << made.shares.size() << ": "
              << std::round(1000 * made.shares[i].cost) / 10 << " % of the surface, in "
              << counted(made.shares[i].pages, "block") << " of 128^3 voxels\n";
}

/// "3/16".
RunPart parseRunPart(const std::string& text) {
  RunPart part;
  const char* const end = text.data() + text.size();
  const auto [slash, error] = std::from_chars(text.data(), end, part.number);
  bool isRead = error == std::errc() && slash != end && *slash == '/';
  if (isRead) {
    const auto [rest, errorOfCount] = std::from_chars(slash + 1, end, part.count);
    isRead = errorOfCount == std::errc() && rest == end;
  }
  if (!isRead) throw UsageError("--part must be I/N, such as 3/16, not '" + text + "'");
  return part;
}

/// Checks the outputs before the work starts.
void requireOutputs(const ConvertArguments& options, const Frame& frame, const Scene& scene) {
  requireOutput(frame.output, options.common, scene);
  if (options.report.empty()) return;
  requireOutput(options.report, options.common, scene);
  if (isSameFile(options.report, frame.output))
    throw UsageError(options.report + ": is the output, too; choose another name");
}

void requireNames(const ConvertArguments& options) {
  if (options.output.empty() && !options.dryRun)
    throw UsageError("--output is required; or see what it would be with --dry-run");
  if (!options.output.empty() && !isStdout(options.output) && !isGridFile(options.output))
    throw UsageError(options.output + ": the output of vox convert must end in .vdb or .nvdb");
  if (!options.report.empty() && lowerExtension(options.report) != ".json")
    throw UsageError(options.report + ": the file of --report must end in .json");
}

/// The grids stay to the end of the process: to free millions of nodes takes longer than to end.
Conversion& conversionOfProcess() {
  static auto* const conversion = new Conversion;
  return *conversion;
}

Scene readFrame(const Frame& frame, const ConvertOptions& options) {
  return onThreads(options.run.threads, [&] { return readScene(frame.input, options.scale); });
}

/// One voxel size for all frames, by the box of them all, so that they share one transform. Checks
/// all inputs and outputs on the way.
void shareVoxelSize(const ConvertArguments& options, const std::vector<Frame>& frames,
                    ConvertOptions& convertOptions) {
  if (!options.report.empty())
    throw UsageError("--report needs a single input, not " + std::to_string(frames.size()));
  Box box;
  Resolution resolution;  // of the options, else of the first scene that sets one
  for (const Frame& frame : frames) {
    const Scene scene = readFrame(frame, convertOptions);
    if (!options.dryRun) requireOutputs(options, frame, scene);
    if (!resolution.isSet()) resolution = resolutionOf(scene, convertOptions);
    requireValidScene(scene);
    box.add(boxOf(scene, preparationsOf(scene, convertOptions)));
  }
  convertOptions.voxelSize = transformFor(resolution, box).voxelSize;
  convertOptions.dim.reset();
}

void runFrame(const ConvertArguments& options, const Frame& frame, ConvertOptions convertOptions) {
  ProgressBar bar(options.common);
  const Stopwatch reading;
  Scene scene = readFrame(frame, convertOptions);
  const double readSeconds = reading.seconds();
  if (options.dryRun) return printEstimate(options, scene, resolve(scene, convertOptions));
  requireOutputs(options, frame, scene);

  Progress progress(bar.callback());
  convertOptions.run.progress = &progress;
  const Request request = resolve(scene, convertOptions);
  requireHeld(frame.output, request.part.has_value(), request.volume.half);
  Conversion& conversion = conversionOfProcess();
  double writeSeconds = 0;
  {
    const CancelOnSignal cancelOnSignal(progress);
    conversion = {};  // the frame before
    conversion = convertScene(std::move(scene), request, options.verify);
    const Stopwatch writing;
    onThreads(options.common.run.threads,
              [&] { write(options, frame.output, conversion, progress); });
    writeSeconds = writing.seconds();
    progress.finish();
  }
  bar.erase();

  const FinishedRun finished{scene,        convertOptions, conversion,
                             frame.output, readSeconds,    writeSeconds};
  if (!options.report.empty()) writeReport(options, finished);
  sayReport(options, finished);
}

/// Files of grids in, and out in another format or compression.
int runCopy(const ConvertArguments& options, const std::vector<Frame>& frames,
            std::optional<Compression> compression) {
  for (const Option& option : options.meshOptions)
    if (option.isGiven())
      throw UsageError(frames[0].input + ": " + option.name() + " is for meshes and scenes only");
  for (const Frame& frame : frames)
    copyGrids(frame.input, frame.output, compression, options.common);
  return 0;
}

int runConvert(const ConvertArguments& options) {
  requireNames(options);
  ConvertOptions convertOptions = parseConvert(options);
  const std::vector<Frame> frames = framesOf(options.inputs, options.output);
  if (isGridFile(frames[0].input))
    return runCopy(options, frames, convertOptions.volume.compression);
  if (frames.size() > 1) shareVoxelSize(options, frames, convertOptions);
  for (const Frame& frame : frames) runFrame(options, frame, convertOptions);
  return 0;
}

/// The input and the output.
void addFiles(const Command& command, ConvertArguments& options) {
  command
      .add(
          "INPUT", options.inputs,
          "Scene (.toml) or mesh (.obj .ply .off .stl .om .gltf .glb). Several inputs, or a "
          "pattern such as mesh.####.obj, become a sequence out.####.vdb with one voxel size. Or a "
          "file of grids (.vdb .nvdb), to be written in the other format or with another "
          "--compression")
      .required()
      .type("");
  command
      .add("-o,--output", options.output,
           "OpenVDB file to write, or NanoVDB file (.nvdb); - for OpenVDB on stdout. Required "
           "without "
           "--dry-run")
      .type("OUT.vdb")
      .group("Output");
}

/// Which grids, and of what.
void addGrids(const Command& command, ConvertArguments& options) {
  command
      .add("--grids", options.grids,
           "Grids to write, with commas: " + allNamesIn(kGridNames) +
               " (default: the scene's, or density)")
      .type("LIST")
      .group("Output");
  command
      .add("--texture", options.conversion.texture,
           "Texture of all objects, in the grid color: " + allTextureNames() +
               "; with parameters: marble:scale=0.2,seed=3 or image:file=F (default: the scene's "
               "textures, "
               "or the images and colours of the meshes)")
      .type("KIND[:KEY=VALUE,...]")
      .group("Output");
  command
      .add("--part", options.part,
           "Make only the I-th of N parts of the grids, for other processes or machines to make "
           "the others: all with the same input and options. vox merge puts the files together. "
           "(These are not the parts of --part-by)")
      .type("I/N")
      .group("Output");
  addPartOptions(command, options.parts);
  addVolumeOptions(command, options.volume);
  addFileOptions(command, options.volume);
}

/// What is told of the run, besides the grids.
void addReports(const Command& command, ConvertArguments& options) {
  command
      .add("--report", options.report,
           "Write times, counts and memory of each stage and object to a file, as JSON")
      .type("FILE.json")
      .group("Output");
  command
      .addFlag("--verify", options.verify,
               "Check the voxels against the surface, as vox check --mesh does, before the file "
               "is written; exit code 1 if they fail")
      .group("Output");
  command
      .addFlag("--dry-run", options.dryRun,
               "Print an estimate of voxels, memory, levels and file size, within a factor of "
               "about 1.5, and write nothing")
      .group("Run");
}

}  // namespace

ConvertOptions parseConvert(const ConvertArguments& options) {
  ConvertOptions parsed = parseConversion(options.conversion, options.common.run);
  parseParts(options.parts, parsed);
  if (!options.part.empty()) parsed.part = parseRunPart(options.part);
  parsed.volume = parseVolume(options.volume);
  if (!options.grids.empty()) parsed.grids = parseGrids(options.grids);
  return parsed;
}

void requireHeld(const std::string& output, bool isPart, bool isHalf) {
  if (!isNvdb(output)) return;
  if (isPart)
    throw UsageError(output + ": has no place for what vox merge must know of parts; write .vdb");
  if (isHalf)
    throw UsageError(output + ": holds floats of 32 bits, not of 16 (--half); write .vdb");
}

Conversion convertScene(Scene&& scene, const Request& request, bool verified) {
  if (!verified) return convert(std::move(scene), request);
  return convertScene(scene, request, verified);
}

Conversion convertScene(const Scene& scene, const Request& request, bool verified) {
  Conversion conversion = convert(scene, request);
  if (verified) verify(conversion, scene, request);
  return conversion;
}

void declareConvert(CLI::App& app, ConvertArguments& options) {
  const Command command(app, "convert",
                        "Convert a mesh or scene into a smooth voxel model (.vdb, .nvdb)");
  addFiles(command, options);
  addConversionOptions(command, options.conversion);
  addGrids(command, options);
  addSubmeshOptions(command, options.conversion.submeshes);
  addReports(command, options);
  for (const Option& option : command.options())
    if (option.name() != "INPUT" && option.name() != "--output" && option.name() != "--compression")
      options.meshOptions.push_back(option);
  addProgressOption(command, options.common);
  addCommonOptions(command, options.common);
}

Action addConvert(CLI::App& app) {
  const auto options = std::make_shared<ConvertArguments>();
  declareConvert(app, *options);
  return [options] { return runConvert(*options); };
}

}  // namespace vox::app
