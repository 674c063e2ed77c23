// vox merge: the parts of a conversion as one .vdb file, or the union of other files.

#include "apps/vox/command.h"
#include "apps/vox/counted.h"
#include "apps/vox/options.h"
#include "libvox/core/error.h"
#include "libvox/core/parallel.h"
#include "libvox/io/atomic_file.h"
#include "libvox/io/input_file.h"
#include "libvox/io/merge_vdb.h"

#include <iostream>
#include <memory>
#include <sstream>

namespace vox::app {
namespace {

struct MergeArguments {
  std::vector<std::string> inputs;
  std::string output;
  bool partial = false;
  CommonOptions common;
};

void requireMergeOutput(const MergeArguments& options) {
  if (isStdout(options.output)) return;
  if (lowerExtension(options.output) != ".vdb")
    throw UsageError(options.output + ": the output of vox merge must end in .vdb");
  for (const std::string& input : options.inputs)
    if (isSameFile(options.output, input))
      throw UsageError(options.output + ": is the input " + input + "; choose another name");
  requireWritable(options.output, options.common.force);
}

MergeReport mergeFiles(const MergeArguments& options) {
  const std::vector<std::filesystem::path> files(options.inputs.begin(), options.inputs.end());
  const MergeOptions merging = {options.partial, options.common.run.maxMemory};
  if (isStdout(options.output)) {
    std::stringstream bytes(std::ios::in | std::ios::out | std::ios::binary);
    MergeReport report = mergeVdb(bytes, files, merging);
    std::cout << bytes.view();
    return report;
  }
  AtomicFile output(options.output, options.common.force);
  MergeReport report = mergeVdb(output.stream(), files, merging);
  output.commit();
  return report;
}

int runMerge(const MergeArguments& options) {
  requireMergeOutput(options);
  const MergeReport report =
      onThreads(options.common.run.threads, [&] { return mergeFiles(options); });
  if (!report.missing.empty())
    say(options.common, "warning: without " + partsText(report.missing) + " of " +
                            std::to_string(report.partCount));
  std::uint64_t voxels = 0;
  for (const MergedGrid& grid : report.grids) voxels += grid.activeVoxels;
  say(options.common, options.output + ": " + counted(report.grids.size(), "grid") + " with " +
                          counted(voxels, "active voxel") + " from " +
                          counted(options.inputs.size(), "file"));
  if (!options.common.verbose) return 0;
  for (const MergedGrid& grid : report.grids)
    say(options.common, "grid " + grid.name + ": " + counted(grid.activeVoxels, "active voxel"));
  return 0;
}

}  // namespace

Action addMerge(CLI::App& app) {
  const Command command(app, "merge", "Merge the parts of a conversion, or other .vdb files");
  const auto options = std::make_shared<MergeArguments>();
  command
      .add("FILE", options->inputs,
           "Parts that vox convert --part wrote, in any order; or files of any program whose "
           "grids are to be united")
      .required()
      .type("");
  command.add("-o,--output", options->output, "OpenVDB file to write; - for stdout")
      .required()
      .type("OUT.vdb")
      .group("Output");
  command.addFlag("--partial", options->partial, "Merge the parts that are there").group("Output");
  addCommonOptions(command, options->common);
  return [options] { return runMerge(*options); };
}

}  // namespace vox::app
