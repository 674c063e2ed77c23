// vox diff: the differences of two .vdb files.

#include "libvox/inspect/diff.h"

#include "apps/vox/command.h"
#include "apps/vox/counted.h"
#include "apps/vox/json.h"
#include "apps/vox/options.h"
#include "libvox/core/error.h"
#include "libvox/io/atomic_file.h"
#include "libvox/io/input_file.h"
#include "libvox/report/diff_report.h"

#include <array>
#include <charconv>
#include <filesystem>
#include <iostream>
#include <memory>
#include <sstream>

namespace vox::app {
namespace {

constexpr int kDifferent = 1;

struct DiffArguments {
  std::string a, b;
  DiffOptions diff;
  std::string grids;
  bool noMetadata = false;
  std::string output;
  std::string report;
  bool force = false;
  bool quiet = false;
  bool json = false;
};

Json toJson(const std::vector<TextDiff>& texts) {
  Json json = Json::array();
  for (const TextDiff& text : texts)
    json.push_back({{"what", text.what}, {"a", text.a}, {"b", text.b}});
  return json;
}

Json toJson(const TopologyDiff& topology) {
  return {{"active", topology.active},
          {"only_a", topology.onlyA},
          {"only_b", topology.onlyB},
          {"first", orNull(topology.first)},
          {"distance", topology.distance}};  // infinity is null in JSON
}

Json toJson(const ValueDiff& values) {
  return {{"compared", values.compared},
          {"differing", values.differing},
          {"first", orNull(values.first)},
          {"largest", values.largest},
          {"rms", values.rms},
          {"inactive_differing", values.inactiveDiffering}};
}

Json toJson(const GridDiff& grid) {
  return {{"name", grid.name},
          {"same", grid.same()},
          {"in_a", grid.inA},
          {"in_b", grid.inB},
          {"properties", toJson(grid.properties)},
          {"metadata", toJson(grid.metadata)},
          {"topology", toJson(grid.topology)},
          {"values", grid.values ? toJson(*grid.values) : Json()}};
}

std::string at(const std::optional<VoxelIndex>& voxel) {
  if (!voxel) return {};
  const auto& [x, y, z] = *voxel;
  return ", first (" + std::to_string(x) + ' ' + std::to_string(y) + ' ' + std::to_string(z) + ')';
}

void print(const std::vector<TextDiff>& texts, const std::string& prefix) {
  const auto quoted = [](const std::string& text) {
    return text.empty() ? std::string("nothing") : "'" + onOneLine(text) + "'";
  };
  for (const TextDiff& text : texts)
    std::cout << "  " << prefix << onOneLine(text.what) << ": " << quoted(text.a) << " in A, "
              << quoted(text.b) << " in B\n";
}

void print(const TopologyDiff& topology) {
  if (topology.same()) return;
  std::cout << "  topology: " << counted(topology.onlyA, "voxel") << " only in A, "
            << topology.onlyB << " only in B" << at(topology.first) << "; up to "
            << topology.distance << " voxels apart\n";
}

void print(const ValueDiff& values) {
  if (values.differing > 0)
    std::cout << "  values: " << values.differing << " of " << values.compared << " differ"
              << at(values.first) << "; by up to " << values.largest << ", rms " << values.rms
              << '\n';
  if (values.inactiveDiffering > 0)
    std::cout << "  values: " << counted(values.inactiveDiffering, "inactive voxel")
              << " have another value\n";
}

void print(const GridDiff& grid) {
  std::cout << onOneLine(grid.name) << ": ";
  if (!grid.inA || !grid.inB) {
    std::cout << "only in " << (grid.inA ? 'A' : 'B') << '\n';
    return;
  }
  if (!grid.same()) {
    std::cout << "differs\n";
    print(grid.properties, "");
    print(grid.topology);
    if (grid.values) print(*grid.values);
    print(grid.metadata, "metadata ");
    return;
  }
  std::cout << "same, " << counted(grid.topology.active[0], "active voxel");
  if (grid.values && grid.values->largest > 0)
    std::cout << "; values within the tolerance, by up to " << grid.values->largest << ", rms "
              << grid.values->rms;
  std::cout << '\n';
}

void print(const FileDiff& diff) {
  for (const GridDiff& grid : diff.grids) print(grid);
  if (diff.metadata.empty()) return;
  std::cout << "file: differs\n";
  print(diff.metadata, "metadata ");
}

void requireNames(const DiffArguments& options) {
  const auto require = [&](const std::string& output, const char* option,
                           const std::string& extension) {
    if (output.empty()) return;
    if (lowerExtension(output) != extension)
      throw UsageError(output + ": the file of " + option + " must end in " + extension);
    for (const std::string& input : {options.a, options.b})
      if (isSameFile(output, input))
        throw UsageError(output + ": is the input " + input + "; choose another name");
    requireWritable(output, options.force);
  };
  require(options.output, "--output", ".vdb");
  require(options.report, "--report", ".html");
}

std::string numberText(double number) {
  std::array<char, 32> text;
  return {text.data(), std::to_chars(text.data(), text.data() + text.size(), number).ptr};
}

/// The words of the command that makes the same comparison.
std::vector<std::string> commandOf(const DiffArguments& options) {
  std::vector<std::string> words = {"vox", "diff", options.a, options.b};
  const auto add = [&](const char* option, const std::string& value) {
    words.insert(words.end(), {option, value});
  };
  if (options.diff.absoluteTolerance != 0)
    add("--tolerance", numberText(options.diff.absoluteTolerance));
  if (options.diff.relativeTolerance != 0)
    add("--relative", numberText(options.diff.relativeTolerance));
  if (!options.grids.empty()) add("--grids", options.grids);
  if (options.noMetadata) words.emplace_back("--no-metadata");
  return words;
}

void writeReport(const DiffArguments& options, const FileDiff& diff) {
  const Comparison comparison{
      options.a,
      options.b,
      options.diff,
      {{std::filesystem::path(options.a).filename().string(), options.a, options.b, diff}},
      commandOf(options)};
  AtomicFile file(options.report, options.force);
  file.stream() << diffReport(comparison);
  file.commit();
}

int runDiff(DiffArguments options) {
  options.diff.metadata = !options.noMetadata;
  std::istringstream names(options.grids);
  for (std::string name; std::getline(names, name, ',');) options.diff.onlyGrids.push_back(name);
  requireNames(options);
  const FileDiff diff = diffVdb(options.a, options.b, options.diff);
  if (!options.output.empty())
    writeDifference(options.a, options.b, options.diff, options.output, options.force);
  if (!options.report.empty()) writeReport(options, diff);
  if (options.json) {
    Json json = {{"a", options.a},
                 {"b", options.b},
                 {"same", diff.same()},
                 {"metadata", toJson(diff.metadata)},
                 {"grids", Json::array()}};
    for (const GridDiff& grid : diff.grids) json["grids"].push_back(toJson(grid));
    std::cout << json.dump(2, ' ', false, Json::error_handler_t::replace) << '\n';
  } else if (!options.quiet) {
    print(diff);
  }
  return diff.same() ? 0 : kDifferent;
}

}  // namespace

Action addDiff(CLI::App& app) {
  const Command command(app, "diff", "Compare two .vdb or .nvdb files");
  const auto options = std::make_shared<DiffArguments>();
  command.add("A", options->a, "OpenVDB file (.vdb) or NanoVDB file (.nvdb)").required();
  command.add("B", options->b, "OpenVDB file to compare it with").required();
  command
      .add("--tolerance", options->diff.absoluteTolerance,
           "Values may differ by this much (default: 0)")
      .type("T")
      .group("Comparison");
  command
      .add("--relative", options->diff.relativeTolerance,
           "Values may differ, in addition, by this fraction of the larger one (default: "
           "0)")
      .type("R")
      .group("Comparison");
  command.add("--grids", options->grids, "Grids to compare, with commas (default: all)")
      .type("LIST")
      .group("Comparison");
  command.addFlag("--no-metadata", options->noMetadata, "Do not compare metadata")
      .group("Comparison");
  command
      .add("-o,--output", options->output,
           "Write the differences as grids: NAME_only_a, NAME_only_b, NAME_difference")
      .type("OUT.vdb")
      .group("Output");
  command
      .add("--report", options->report,
           "Write a page for people: what differs, with pictures. It needs no other file")
      .type("OUT.html")
      .group("Output");
  command.addFlag("-f,--force", options->force, "Overwrite an existing output file")
      .group("Output");
  command.addFlag("--json", options->json, "Print JSON").group("Output");
  command.addFlag("-q,--quiet", options->quiet, "Print nothing; the exit code tells")
      .group("Output");
  command.footer("Exit code 0: the same; 1: different.");
  return [options] { return runDiff(*options); };
}

}  // namespace vox::app
