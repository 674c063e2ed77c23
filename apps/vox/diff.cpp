// vox diff: the differences of two files of grids, or of two folders of them.

#include "apps/vox/diff.h"

#include "apps/vox/counted.h"
#include "apps/vox/diff_junit.h"
#include "apps/vox/diff_text.h"
#include "apps/vox/options.h"
#include "libvox/core/error.h"
#include "libvox/inspect/diff_folders.h"
#include "libvox/io/atomic_file.h"
#include "libvox/io/input_file.h"
#include "libvox/io/write_junit.h"
#include "libvox/report/diff_report.h"

#include <algorithm>
#include <filesystem>
#include <iostream>
#include <memory>
#include <sstream>
#include <string>
#include <system_error>
#include <utility>
#include <vector>

namespace vox::app {
namespace {

constexpr int kDifferent = 1;

bool isFolder(const std::string& path) {
  std::error_code ignored;
  return std::filesystem::is_directory(path, ignored);
}

/// @throws UsageError  one is a folder, the other is none
/// @throws InputError  one is a folder, the other does not exist
bool areFolders(const DiffArguments& options) {
  const bool folders = isFolder(options.a);
  if (folders == isFolder(options.b)) return folders;
  const std::string& other = folders ? options.b : options.a;
  std::error_code ignored;
  if (!std::filesystem::exists(other, ignored))
    throw InputError(other + ": no such folder; check the path");
  throw UsageError(other + ": is no folder, but " + (folders ? options.a : options.b) +
                   " is; name two files or two folders");
}

void requireOutputs(const DiffArguments& options, bool folders) {
  if (!options.output.empty() && folders) throw UsageError("--output needs two files, not folders");
  const auto require = [&](const std::string& output, const char* option, const char* extension) {
    requireOutput(output, option, extension, {options.a, options.b}, options.force);
  };
  require(options.output, "--output", ".vdb");
  require(options.junit, "--junit", ".xml");
  require(options.report, "--report", ".html");
}

/// The words of the command that makes the same comparison.
std::vector<std::string> commandOf(const DiffArguments& options) {
  std::vector<std::string> words = {"vox", "diff", options.a, options.b};
  const auto add = [&](const char* option, double tolerance) {
    if (tolerance != 0) words.insert(words.end(), {option, shortestText(tolerance)});
  };
  add("--tolerance", options.diff.absoluteTolerance);
  add("--relative", options.diff.relativeTolerance);
  add("--tolerance-voxels", options.diff.voxelTolerance);
  if (!options.grids.empty()) words.insert(words.end(), {"--grids", options.grids});
  if (options.noMetadata) words.emplace_back("--no-metadata");
  return words;
}

/// Writes the page for people.
void writePage(const DiffArguments& options, std::vector<FilePairDiff> files, bool folders) {
  if (options.report.empty()) return;
  AtomicFile output(options.report, options.force);
  output.stream() << diffReport({.a = options.a,
                                 .b = options.b,
                                 .areFolders = folders,
                                 .options = options.diff,
                                 .files = std::move(files),
                                 .command = commandOf(options)});
  output.commit();
}

void writeJunitReport(const DiffArguments& options, const JunitSuite& suite) {
  if (options.junit.empty()) return;
  AtomicFile output(options.junit, options.force);
  writeJunit(output.stream(), suite);
  output.commit();
}

std::string suiteName(const DiffArguments& options) {
  return "vox diff " + options.a + ' ' + options.b;
}

template <class Tell>
bool compareFiles(const DiffArguments& options, Tell&& tellResult) {
  const FileDiff diff = diffVdb(options.a, options.b, options.diff);
  if (!options.output.empty())
    writeDifference(options.a, options.b, options.diff, options.output, options.force);
  FilePairDiff files;
  files.name = options.a;
  files.inA = files.inB = true;
  files.diff = diff;
  writeJunitReport(options, suiteOf(diff, suiteName(options)));
  tellResult(diff);  // first: a page may be too large for the memory
  writePage(options, {files}, false);
  return diff.same();
}

template <class Tell>
bool compareFolders(const DiffArguments& options, Tell&& tellResult) {
  const FolderDiff diff = diffFolders(options.a, options.b, options.diff);
  writeJunitReport(options, suiteOf(diff, suiteName(options)));
  tellResult(diff);
  writePage(options, diff.files, true);
  const auto isWrong = [](const FilePairDiff& file) { return !file.error.empty(); };
  const auto wrong = std::find_if(diff.files.begin(), diff.files.end(), isWrong);
  if (wrong == diff.files.end()) return diff.same();
  const std::string message =
      std::to_string(std::count_if(diff.files.begin(), diff.files.end(), isWrong)) + " of " +
      counted(diff.files.size(), "file") + " could not be compared; the first: " + wrong->error;
  if (wrong->exitCode == LimitError("").exitCode()) throw LimitError(message);
  throw InputError(message);
}

/// Compares as the arguments say, writes what they ask for, and tells the result.
/// @param tellResult  is called with a FileDiff or a FolderDiff
/// @return  true if there is no difference
template <class Tell>
bool compare(DiffArguments options, Tell&& tellResult) {
  options.diff.metadata = !options.noMetadata;
  std::istringstream names(options.grids);
  for (std::string name; std::getline(names, name, ',');) options.diff.onlyGrids.push_back(name);
  const bool folders = areFolders(options);
  requireOutputs(options, folders);
  if (folders) return compareFolders(options, tellResult);
  try {
    return compareFiles(options, tellResult);
  } catch (const InputError& error) {
    writeJunitReport(options, suiteOfError(error.what(), suiteName(options)));
    throw;
  }
}

int runDiff(const DiffArguments& options) {
  const bool same = compare(options, [&](const auto& diff) {
    if (options.json)
      std::cout << textOf(jsonOf(diff, options.a, options.b)) << '\n';
    else if (!options.quiet)
      std::cout << textOf(diff);
  });
  return same ? 0 : kDifferent;
}

}  // namespace

std::string diffJson(const DiffArguments& options) {
  std::string json;
  compare(options, [&](const auto& diff) { json = textOf(jsonOf(diff, options.a, options.b)); });
  return json;
}

void declareDiff(CLI::App& app, DiffArguments& options) {
  const Command command(app, "diff",
                        "Compare two .vdb or .nvdb files, or all such files of two folders");
  command.add("A", options.a, "OpenVDB file (.vdb), NanoVDB file (.nvdb), or folder of such files")
      .required();
  command
      .add("B", options.b,
           "File or folder to compare it with; files of folders are compared by name")
      .required();
  command
      .add("--tolerance", options.diff.absoluteTolerance,
           "Values may differ by this much (default: 0)")
      .type("T")
      .group("Comparison");
  command
      .add("--relative", options.diff.relativeTolerance,
           "Values may differ, in addition, by this fraction of the larger one (default: "
           "0)")
      .type("R")
      .group("Comparison");
  command
      .add("--tolerance-voxels", options.diff.voxelTolerance,
           "Active voxels may be this far from those of the other grid, in voxels (default: 0); "
           "values are compared where both are active")
      .type("D")
      .group("Comparison");
  command.add("--grids", options.grids, "Grids to compare, with commas (default: all)")
      .type("LIST")
      .group("Comparison");
  command.addFlag("--no-metadata", options.noMetadata, "Do not compare metadata")
      .group("Comparison");
  command
      .add("-o,--output", options.output,
           "Write the differences as grids: NAME_only_a, NAME_only_b, NAME_difference")
      .type("OUT.vdb")
      .group("Output");
  command
      .add("--junit", options.junit,
           "Write a report that CI systems show: a test for each grid, of folders for each file")
      .type("OUT.xml")
      .group("Output");
  command
      .add("--report", options.report,
           "Write a page for people: what differs, with pictures. It needs no other file")
      .type("OUT.html")
      .group("Output");
  command.addFlag("-f,--force", options.force, "Overwrite an existing output file").group("Output");
  command.addFlag("--json", options.json, "Print JSON").group("Output");
  command.addFlag("-q,--quiet", options.quiet, "Print nothing; the exit code tells")
      .group("Output");
  command.footer("Exit code 0: the same; 1: different; 3: a file cannot be read.");
}

Action addDiff(CLI::App& app) {
  const auto options = std::make_shared<DiffArguments>();
  declareDiff(app, *options);
  return [options] { return runDiff(*options); };
}

}  // namespace vox::app
