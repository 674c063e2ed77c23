// vox check: faults of a .vdb file.

#include "apps/vox/check.h"

#include "apps/vox/counted.h"
#include "apps/vox/json.h"
#include "apps/vox/verify.h"
#include "libvox/core/error.h"
#include "libvox/core/names.h"
#include "libvox/core/parallel.h"
#include "libvox/grid/openvdb.h"
#include "libvox/inspect/components.h"
#include "libvox/inspect/lint.h"
#include "libvox/inspect/topology.h"
#include "libvox/io/atomic_file.h"
#include "libvox/io/input_file.h"
#include "libvox/io/read_vdb.h"
#include "libvox/options/option_text.h"
#include "libvox/options/run_part.h"
#include "libvox/pipeline/request.h"
#include "libvox/report/check_report.h"
#include "libvox/volume/joined_parts.h"

#include <algorithm>
#include <iostream>
#include <memory>
#include <sstream>

namespace vox::app {
namespace {

constexpr int kFaulty = 1;
constexpr const char* kLeak = "leak";
constexpr const char* kTunnel = "tunnel";

/// Result of the check.
struct Check {
  openvdb::GridBase::Ptr voxels;  ///< those that are checked; null if there are none
  std::string grid;               ///< name of their grid; "" if there is none
  std::uint64_t activeVoxels = 0;
  std::vector<Component> components;
  std::vector<Component> enclosed;
  std::vector<ObjectCheck> objects;
  std::vector<LintFinding> findings;
  std::vector<VoxelIndex> places;  ///< of findings
};

std::vector<std::string> listOf(const std::string& text) {
  std::vector<std::string> words;
  std::istringstream list(text);
  for (std::string word; std::getline(list, word, ',');) words.push_back(word);
  return words;
}

std::vector<std::string> ignoredCodes(const CheckArguments& options) {
  std::vector<std::string> known = {kLeak, kTunnel};
  for (const LintRule& rule : lintRules()) known.emplace_back(rule.code);
  const std::vector<std::string> codes = listOf(options.ignore);
  for (const std::string& code : codes)
    if (std::find(known.begin(), known.end(), code) == known.end()) {
      std::string all;
      for (const std::string& one : known) all += (all.empty() ? "" : ", ") + one;
      throw UsageError("--ignore: unknown fault '" + code + "'; known are " + all);
    }
  return codes;
}

/// The grid whose voxels are the surface; null if the file has none and the options need none.
openvdb::GridBase::Ptr chooseGrid(const VdbFile& file, const CheckArguments& options) {
  const auto named = [&](const std::string& name) -> openvdb::GridBase::Ptr {
    for (const NamedGrid& grid : file.grids)
      if (grid.name == name) return grid.grid;
    return nullptr;
  };
  if (!options.grid.empty()) {
    if (const auto grid = named(options.grid)) return grid;
    throw InputError(options.file + ": has no grid '" + options.grid + "'");
  }
  for (const char* name : {"mask", "density"})
    if (const auto grid = named(name)) return grid;
  std::vector<openvdb::GridBase::Ptr> grids;
  for (const NamedGrid& grid : file.grids) grids.push_back(grid.grid);
  if (const auto parts = joinedParts(grids)) return parts;
  if (!options.mesh.empty())
    throw UsageError(options.file + ": has neither mask nor density; say --grid NAME");
  return nullptr;
}

std::string metadataOf(const openvdb::GridBase& grid, const std::string& key) {
  const auto value = grid[key];
  return value ? value->str() : std::string();
}

/// Refuses options that no conversion accepts.
/// @throws InputError
void requirePossible(const ConvertOptions& recorded) {
  Scene plain;
  plain.objects.push_back({.name = "any object", .mesh = {}});
  try {
    resolve(plain, recorded);
  } catch (const UsageError& wrong) {
    throw InputError(std::string(kOptionsMetadata) + " is impossible: " + wrong.what());
  }
}

/// The options that the metadata of a grid records.
/// @throws InputError  the metadata is damaged, or of another program; the message names the file
RecordedOptions recordedOptions(const openvdb::GridBase& grid, const std::string& file) {
  try {
    RecordedOptions recorded = parseOptionText(metadataOf(grid, kOptionsMetadata));
    const std::string guarantee = metadataOf(grid, kGuaranteeMetadata);
    if (!guarantee.empty()) recorded.options.separation = parseGuarantee(guarantee);
    requirePossible(recorded.options);
    return recorded;
  } catch (const InputError& wrong) {
    throw InputError(file + ": " + wrong.what());
  }
}

/// @throws UsageError  a list that the file was made with is not given
void requireLists(const std::vector<std::string>& lists, const SmoothingOptions& given,
                  const std::string& file) {
  const auto require = [&](const char* list, const char* option, bool isGiven) {
    if (!isGiven && std::find(lists.begin(), lists.end(), list) != lists.end())
      throw UsageError(file + ": was made with " + option + "; give the same file here");
  };
  require("interpolated-vertices", "--interpolate-vertices",
          given.interpolatedVertices.has_value());
  require("crease-edges", "--crease-edges", given.creaseEdges.has_value());
  require("corner-vertices", "--corner-vertices", given.cornerVertices.has_value());
}

/// The options that the file was made with; those of the command line win.
/// @throws InputError  as recordedOptions
/// @throws UsageError  the file was made with a list of vertices, which it does not hold
ConvertOptions optionsOfFile(const openvdb::GridBase& grid, const CheckArguments& options) {
  RecordedOptions recorded = recordedOptions(grid, options.file);
  ConvertOptions& made = recorded.options;
  const SmoothingOptions given = parseSmoothing(options.smoothing);
  requireLists(recorded.lists, given, options.file);
  if (given.boundary) made.smoothing.boundary = given.boundary;
  if (given.interpolate) made.smoothing.interpolate = given.interpolate;
  if (given.faces) made.smoothing.faces = given.faces;
  made.smoothing.interpolatedVertices = given.interpolatedVertices;
  if (given.crease) made.smoothing.crease = given.crease;
  made.smoothing.creaseEdges = given.creaseEdges;
  made.smoothing.cornerVertices = given.cornerVertices;
  if (options.weldTolerance) made.weldTolerance = options.weldTolerance;
  if (!options.until.empty()) {
    made.until = parseUntil({{options.until}, {}, {}});
    // Limits mean polygons, even if file or scene name vertices.
    if (!made.until->untilVoxel()) made.voxelize = Voxelize::kAuto;
  }
  made.run = options.run;
  return made;
}

/// @param input  the scene of --mesh; null: it is read
void checkMesh(const openvdb::GridBase& grid, const openvdb::MaskTree& voxels,
               const CheckArguments& options, const Scene* input, Check& check) {
  if (!grid.transform().isLinear() || !grid.hasUniformVoxels())
    throw InputError(options.file + ": a mesh can be held against voxels that are cubes only");
  if (grid[kRunPartMetadata])
    throw InputError(options.file +
                     ": holds a part of its grids (--part): a mesh can be held against whole grids "
                     "only; put the parts together with vox merge");
  if (const auto missing = grid[kMissingPartsMetadata])
    throw InputError(options.file + ": lacks " + missing->str() +
                     ": a mesh can be held against whole grids only");
  const ConvertOptions made = optionsOfFile(grid, options);
  if (made.bounds || made.clip)
    throw InputError(
        options.file +
        ": was cropped (--bounds, --clip): a mesh can be held against whole grids only");
  if (made.volume.alpha == Alpha::kCut)
    throw InputError(options.file +
                     ": has holes (--alpha cut): a mesh can be held against whole grids only");
  if (input != nullptr && made.scale)
    throw UsageError(options.file + ": was made with --scale; name the file of the mesh instead");
  const Scene read = input != nullptr ? Scene() : readScene(options.mesh, made.scale);
  const Scene& scene = input != nullptr ? *input : read;
  check.objects = checkObjects(voxels, scene, resolve(scene, made), grid.voxelSize().x());
  for (const ObjectCheck& object : check.objects) {
    if (object.separation.tunnels == 0) continue;
    check.findings.push_back({kTunnel, check.grid,
                              object.name + ": " + separationText(object.separation) +
                                  ": the voxels do not separate the sides of the surface"});
    if (object.separation.first) check.places.push_back(*object.separation.first);
  }
}

void checkLeaks(const openvdb::MaskTree& voxels, Check& check) {
  constexpr std::uint64_t kLeastVoxels = 200;
  for (const Component& space : leakingSpaces(voxels, kLeastVoxels)) {
    const auto& [x, y, z] = space.first;
    std::ostringstream text;
    text << "a space of " << space.voxels << " voxels at (" << x << ' ' << y << ' ' << z
         << ") is enclosed but for a hole of one or two voxels";
    check.findings.push_back({kLeak, check.grid, text.str()});
    check.places.push_back(space.first);
  }
}

Check checkFile(const CheckArguments& options, const Scene* input) {
  const std::vector<std::string> ignored = ignoredCodes(options);
  Check check;
  check.findings = lintVdb(options.file);
  const VdbFile file = readVdb(options.file);
  if (const auto grid = chooseGrid(file, options)) {
    const openvdb::MaskTree::Ptr voxels = topologyOf(*grid);
    check.voxels = grid;
    check.grid = grid->getName();
    check.activeVoxels = grid->activeVoxelCount();
    check.components = activeComponents(*voxels);
    check.enclosed = Cavities(*voxels).enclosed();
    if (options.mesh.empty())
      checkLeaks(*voxels, check);
    else
      checkMesh(*grid, *voxels, options, input, check);
  }
  std::erase_if(check.findings, [&](const LintFinding& finding) {
    return std::find(ignored.begin(), ignored.end(), finding.code) != ignored.end();
  });
  return check;
}

Json toJson(const std::vector<Component>& components) {
  constexpr std::size_t kMost = 100;
  Json json = {{"count", components.size()}, {"first", Json::array()}};
  for (std::size_t i = 0; i < std::min(kMost, components.size()); ++i)
    json["first"].push_back({{"voxels", components[i].voxels}, {"at", components[i].first}});
  return json;
}

std::size_t faultCount(const Check& check) {
  return static_cast<std::size_t>(
      std::count_if(check.findings.begin(), check.findings.end(),
                    [](const LintFinding& finding) { return finding.isFault; }));
}

Json toJson(const CheckArguments& options, const Check& check) {
  Json json = {{"file", options.file},
               {"ok", faultCount(check) == 0},
               {"grid", check.grid},
               {"active_voxels", check.activeVoxels},
               {"components", toJson(check.components)},
               {"enclosed", toJson(check.enclosed)},
               {"objects", Json::array()},
               {"faults", Json::array()},
               {"warnings", Json::array()}};
  for (const ObjectCheck& object : check.objects) {
    const auto& first = object.separation.first;
    json["objects"].push_back({{"name", object.name},
                               {"tunnels", object.separation.tunnels},
                               {"first", first ? Json(*first) : Json()}});
  }
  for (const LintFinding& finding : check.findings)
    json[finding.isFault ? "faults" : "warnings"].push_back(
        {{finding.isFault ? "fault" : "warning", finding.code},
         {"grid", finding.grid},
         {"message", finding.message}});
  return json;
}

void print(const CheckArguments& options, const Check& check) {
  if (!check.grid.empty()) {
    std::uint64_t within = 0;
    for (const Component& space : check.enclosed) within += space.voxels;
    std::cout << onOneLine(check.grid) << ": " << counted(check.activeVoxels, "active voxel")
              << " in " << counted(check.components.size(), "component") << ", around "
              << counted(check.enclosed.size(), "enclosed space");
    if (within > 0) std::cout << " of " << counted(within, "voxel");
    std::cout << '\n';
  }
  for (const ObjectCheck& object : check.objects)
    std::cout << onOneLine(object.name) << ": " << separationText(object.separation) << '\n';
  for (const LintFinding& finding : check.findings)
    std::cout << (finding.isFault ? "fault " : "warning ") << finding.code << ": "
              << onOneLine(finding.grid.empty() ? options.file : finding.grid) << ": "
              << onOneLine(finding.message) << '\n';
  std::cout << (faultCount(check) == 0 ? "no faults" : counted(faultCount(check), "fault")) << '\n';
}

/// The words of the command that makes the same check.
std::vector<std::string> commandOf(const CheckArguments& options) {
  std::vector<std::string> words = {"vox", "check", options.file};
  const auto add = [&](const char* option, const std::string& value) {
    if (!value.empty()) words.insert(words.end(), {option, value});
  };
  add("--mesh", options.mesh);
  add("--grid", options.grid);
  add("--boundary", options.smoothing.boundary);
  add("--interpolate", options.smoothing.interpolate);
  add("--interpolate-vertices", options.smoothing.vertexFile);
  add("--crease", options.smoothing.creases.rule);
  add("--crease-edges", options.smoothing.creases.edgeFile);
  add("--corner-vertices", options.smoothing.creases.cornerFile);
  add("--faces", options.smoothing.faces);
  add("--until", options.until);
  if (options.weldTolerance) add("--weld", shortestText(*options.weldTolerance));
  add("--ignore", options.ignore);
  return words;
}

void writeReport(const CheckArguments& options, const Check& check) {
  std::vector<std::string> notes;
  for (const ObjectCheck& object : check.objects)
    notes.push_back(object.name + ": " + separationText(object.separation) + '.');
  AtomicFile file(options.report, options.force);
  file.stream() << checkReport({options.file, commandOf(options), check.voxels, check.components,
                                check.enclosed, notes, check.findings, check.places});
  file.commit();
}

/// Checks, tells the result, and writes the page: last, since it may be too large for the memory.
/// @param input  as for checkFile
template <class Tell>
Check checkAndTell(const CheckArguments& options, const Scene* input, Tell&& tell) {
  requireOutput(options.report, "--report", ".html", {options.file, options.mesh}, options.force);
  return onThreads(options.run.threads, [&] {
    Check check = checkFile(options, input);
    tell(check);
    if (!options.report.empty()) writeReport(options, check);
    return check;
  });
}

int runCheck(const CheckArguments& options) {
  const Check check = checkAndTell(options, nullptr, [&](const Check& found) {
    if (options.json)
      std::cout << textOf(toJson(options, found)) << '\n';
    else if (!options.quiet)
      print(options, found);
  });
  return faultCount(check) == 0 ? 0 : kFaulty;
}

std::string footer() {
  std::string text =
      "Exit code 0: no faults, or only warnings; 1: some. Faults that are looked for:\n";
  const auto line = [&](const std::string& code, const std::string& what) {
    constexpr std::size_t kWidth = 14;
    text += "  " + code + std::string(kWidth - std::min(kWidth, code.size()), ' ') + what + '\n';
  };
  line(kTunnel, "with --mesh: the voxels do not separate the two sides of the surface");
  line(kLeak, "without --mesh: a space that one or two voxels more would enclose");
  for (const LintRule& rule : lintRules()) line(rule.code, rule.what);
  return text;
}

}  // namespace

std::string checkJson(const CheckArguments& options, const Scene* input) {
  return textOf(toJson(options, checkAndTell(options, input, [](const Check&) {})));
}

void declareCheck(CLI::App& app, CheckArguments& options) {
  const Command command(
      app, "check", "Find faults of a .vdb file: tunnels, leaks, grids that viewers do not show");
  command.add("FILE", options.file, "OpenVDB file (.vdb) or NanoVDB file (.nvdb) of any program")
      .required();
  command
      .add("--mesh", options.mesh,
           "Scene or mesh that the file was made from. The voxels are compared with its "
           "surface, which is made again: they must leave no tunnels")
      .type("INPUT")
      .group("Surface");
  command
      .add("--grid", options.grid,
           "Grid whose active voxels are the surface (default: mask, or density)")
      .type("NAME")
      .group("Surface");
  addSmoothingOptions(command, options.smoothing);
  command
      .add("--until", options.until,
           "--until of the conversion that made the file. By default this and all other "
           "options of the conversion are read from the metadata of the file")
      .type("voxel|levels=K")
      .group("Surface");
  addWeldOption(command, options.weldTolerance);
  command
      .add("--ignore", options.ignore,
           "Faults and warnings that do not count, with commas; their names are below")
      .type("LIST")
      .group("Output");
  command
      .add("--report", options.report,
           "Write a page for people: what was found, with pictures. It needs no other file")
      .type("OUT.html")
      .group("Output");
  command.addFlag("-f,--force", options.force, "Overwrite an existing output file").group("Output");
  command.addFlag("--json", options.json, "Print JSON").group("Output");
  command.addFlag("-q,--quiet", options.quiet, "Print nothing; the exit code tells")
      .group("Output");
  addRunOptions(command, options.run);
  command.footer(footer());
}

Action addCheck(CLI::App& app) {
  const auto options = std::make_shared<CheckArguments>();
  declareCheck(app, *options);
  return [options] { return runCheck(*options); };
}

}  // namespace vox::app
