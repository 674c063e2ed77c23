// vox info: properties of a mesh, scene or file of grids, and of the mesh after preparation.

#include "apps/vox/info.h"

#include "apps/vox/counted.h"
#include "apps/vox/json.h"
#include "libvox/core/error.h"
#include "libvox/core/memory.h"
#include "libvox/core/progress.h"
#include "libvox/inspect/summary.h"
#include "libvox/io/grid_file.h"
#include "libvox/io/scene_file.h"
#include "libvox/pipeline/refine.h"
#include "libvox/pipeline/request.h"
#include "libvox/prepare/debris.h"
#include "libvox/prepare/gaps.h"
#include "libvox/prepare/sound.h"

#include <algorithm>
#include <array>
#include <iomanip>
#include <iostream>
#include <memory>
#include <numeric>
#include <optional>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

namespace vox::app {
namespace {

std::map<DefectKind, std::uint64_t> countByKind(const std::vector<Defect>& defects) {
  std::map<DefectKind, std::uint64_t> counts;
  for (const Defect& defect : defects) ++counts[defect.kind];
  return counts;
}

Json histogramJson(const std::map<std::uint64_t, std::uint64_t>& histogram) {
  Json json = Json::object();
  for (const auto& [value, count] : histogram) json[std::to_string(value)] = count;
  return json;
}

Json toJson(const MeshSummary& mesh) {
  const auto vector = [](const Vec3d& v) { return Json{v.x(), v.y(), v.z()}; };
  Json json = {{"vertices", mesh.points},
               {"edges", mesh.edges},
               {"faces", mesh.faces},
               {"components", mesh.components},
               {"closed", mesh.closed},
               {"orientable", mesh.orientable},
               {"genus", mesh.genus ? Json(*mesh.genus) : Json()},
               {"euler_characteristic", mesh.eulerCharacteristic},
               {"boundary_loops", mesh.boundaryLoops},
               {"face_sizes", histogramJson(mesh.faceSizes)},
               {"valences", histogramJson(mesh.valences)},
               {"low", vector(mesh.box.low)},
               {"high", vector(mesh.box.high)},
               {"defects", Json::object()}};
  for (const auto& [kind, count] : countByKind(mesh.defects))
    json["defects"][defectName(kind)] = count;
  return json;
}

Json toJson(const SoundReport& report) {
  Json json = Json::object();
  for (std::size_t k = 0; k < kRepairKindCount; ++k) {
    const RepairAction& action = report.repair.actions[k];
    if (action.count > 0)
      json[repairName(static_cast<RepairKind>(k))] = {{"count", action.count},
                                                      {"first", action.message}};
  }
  const OrientReport& orient = report.orient;
  if (orient.flippedFaces > 0)
    json["flipped faces"] = {{"count", orient.flippedFaces}, {"first", orient.firstFlipped}};
  if (!orient.oneSided.empty())
    json["doubled one-sided components"] = {{"count", orient.oneSided.size()},
                                            {"first", orient.oneSided[0]}};
  return json;
}

Json toJson(const FaceSplitReport& report) {
  const auto splitJson = [](const FaceSplit& split) {
    return Json{{"count", split.faces}, {"parts", split.parts}, {"first", split.first}};
  };
  Json json = Json::object();
  if (report.keyholes.faces > 0) json["faces with holes"] = splitJson(report.keyholes);
  if (report.concave.faces > 0) json["concave faces"] = splitJson(report.concave);
  return json;
}

Json toJson(const GapReport& gaps) {
  const auto gap = [](const Gap& g) {
    return Json{{"width", g.width}, {"at", {g.at.x(), g.at.y(), g.at.z()}}};
  };
  Json json = {{"count", gaps.count}};
  if (gaps.count == 0) return json;
  json["widest"] = gap(gaps.widest);
  json["narrowest"] = gap(gaps.narrowest);
  json["weld"] = gaps.weld ? Json(*gaps.weld) : Json();
  json["closed_by_weld"] = gaps.closes;
  return json;
}

Json toJson(const GridSummary& grid) {
  return {{"name", grid.name},
          {"type", grid.type},
          {"class", grid.gridClass},
          {"active_voxels", grid.activeVoxels},
          {"leaves", grid.leaves},
          {"memory_bytes", grid.memoryBytes},
          {"low", grid.low},
          {"high", grid.high},
          {"voxel_size", grid.voxelSize},
          {"origin", grid.origin},
          {"metadata", grid.metadata}};
}

/// The names of sets that have faces, each with the number of its faces.
std::vector<std::pair<std::string, Index>> countedSets(const FaceSets& sets) {
  std::vector<Index> counts(sets.names.size(), 0);
  for (const Index set : sets.ofFaces)
    if (set != kNone) ++counts[set];
  std::vector<std::pair<std::string, Index>> all;
  for (std::size_t k = 0; k < counts.size(); ++k)
    if (counts[k] > 0) all.emplace_back(sets.names[k], counts[k]);
  return all;
}

/// The sets of faces that `vox convert --part-by` and `--split` can tell apart, and the images of
/// materials.
Json toJson(const MeshAttributes& attributes) {
  const auto setsJson = [](const FaceSets& sets) {
    Json json = Json::object();
    for (const auto& [name, count] : countedSets(sets)) json[name] = count;
    return json;
  };
  Json images = Json::array();
  for (const Material& look : attributes.looks)
    if (look.image) images.push_back(look.image->file);
  return {{"objects", setsJson(attributes.objects)},
          {"groups", setsJson(attributes.groups)},
          {"materials", setsJson(attributes.materials)},
          {"images", images},
          {"texture_coordinates", !attributes.texcoords.empty()}};
}

/// The first few of some names, on one line.
std::string namesText(const std::vector<std::string>& names) {
  constexpr std::size_t kMost = 6;
  std::string text = std::to_string(names.size()) + ": ";
  for (std::size_t k = 0; k < std::min(kMost, names.size()); ++k)
    text += (k > 0 ? ", " : "") + onOneLine(names[k]);
  return text + (names.size() > kMost ? ", ..." : "");
}

void print(const MeshAttributes& attributes) {
  const auto line = [](const char* title, const std::vector<std::string>& names) {
    if (!names.empty())
      std::cout << "    " << std::left << std::setw(18) << title << namesText(names) << '\n';
  };
  const auto namesOf = [](const FaceSets& sets) {
    std::vector<std::string> names;
    for (const auto& [name, count] : countedSets(sets))
      names.push_back(name + " (" + counted(count, "face") + ")");
    return names;
  };
  line("objects", namesOf(attributes.objects));
  line("groups", namesOf(attributes.groups));
  line("materials", namesOf(attributes.materials));
  std::vector<std::string> images;
  for (const Material& look : attributes.looks)
    if (look.image) images.push_back(look.image->file);
  line("images", images);
}

std::string histogramText(const std::map<std::uint64_t, std::uint64_t>& histogram) {
  std::ostringstream text;
  for (const auto& [value, count] : histogram)
    text << (text.tellp() > 0 ? ", " : "") << value << ": " << count;
  return text.str();
}

std::string surfaceText(const MeshSummary& mesh) {
  std::string text = mesh.closed ? "closed, " : "open, ";
  text += mesh.orientable ? "orientable, " : "not orientable, ";
  if (mesh.genus) text += "genus " + std::to_string(*mesh.genus) + ", ";
  return text + "Euler characteristic " + std::to_string(mesh.eulerCharacteristic);
}

std::string boundaryText(const std::vector<std::uint64_t>& loops) {
  constexpr std::size_t kMost = 8;
  std::string text = counted(loops.size(), "loop") + " of ";
  if (loops.size() > kMost) {
    const auto [least, most] = std::minmax_element(loops.begin(), loops.end());
    const auto all = std::accumulate(loops.begin(), loops.end(), std::uint64_t{0});
    return text + std::to_string(*least) + " to " + counted(*most, "edge") + ", " +
           std::to_string(all) + " in all";
  }
  for (std::size_t k = 0; k < loops.size(); ++k)
    text += (k > 0 ? ", " : "") + std::to_string(loops[k]);
  return text + (loops.size() == 1 && loops[0] == 1 ? " edge" : " edges");
}

void print(const std::string& title, const MeshSummary& mesh) {
  std::cout << "  " << title << ": " << mesh.points << " vertices, " << mesh.edges << " edges, "
            << mesh.faces << " faces, " << counted(mesh.components, "component") << '\n'
            << "    surface           " << surfaceText(mesh) << '\n'
            << "    corners per face  " << histogramText(mesh.faceSizes) << '\n'
            << "    valence           " << histogramText(mesh.valences) << '\n'
            << "    box               " << exactPoint(mesh.box.low) << " to "
            << exactPoint(mesh.box.high) << '\n';
  if (!mesh.closed)
    std::cout << "    boundary          " << boundaryText(mesh.boundaryLoops) << '\n';
  for (const auto& [kind, count] : countByKind(mesh.defects))
    std::cout << "    defect            " << defectName(kind) << ": " << count << '\n';
  for (const Defect& defect : mesh.defects)
    if (!defect.message.empty()) std::cout << "      " << defect.message << '\n';
}

/// A mesh as it is, the repairs of preparation, and the mesh after them.
Json describe(const Scene& scene, std::size_t number, const ObjectPreparation& preparation,
              bool json) {
  const SceneObject& object = scene.objects[number];
  MeshSummary input = summarize(object.mesh);
  RepairOptions options;
  options.weldTolerance = preparation.weldTolerance;
  options.faces = preparation.faces;
  options.allConvex = preparation.mayCrease();
  const ComponentLimit& limit = preparation.dropComponents;
  options.noteUnused = limit.dropsNothing();
  DebrisReport debris;
  SoundReport report;
  const PolygonMesh kept =
      limit.dropsNothing() ? object.mesh : withoutDebris(object.mesh, limit, options, debris);
  const MeshSummary prepared = summarize(soundMesh(kept, options, report));
  const GapReport gaps = prepared.closed ? GapReport() : measureGaps(kept, options);
  std::optional<CreaseCounts> creases;
  if (preparation.mayCrease() && prepared.faces > 0) {
    Progress unwatched;
    creases = prepare(scene, object, preparation, MemoryBudget(RunOptions().maxMemory), unwatched)
                  .creases;
  }
  // Faces with holes run along a bridge twice, so they repeat corners. That is no defect.
  const auto repeatsCorner = [](const Defect& d) { return d.kind == DefectKind::kRepeatedCorner; };
  const auto repeating = std::count_if(input.defects.begin(), input.defects.end(), repeatsCorner);
  if (static_cast<std::uint64_t>(repeating) == report.repair.faces.keyholes.faces)
    std::erase_if(input.defects, repeatsCorner);
  if (json) {
    Json all = {{"name", object.name}};
    all["reading"] = lossText(object.reading);
    all.update(toJson(input));
    all["attributes"] = toJson(object.mesh.attributes);
    all["dropped"] = {{"components", debris.dropped}, {"faces", debris.droppedFaces}};
    all["repair"] = toJson(report);
    all["split"] = toJson(report.repair.faces);
    all["prepared"] = toJson(prepared);
    all["gaps"] = toJson(gaps);
    if (creases)
      all["creases"] = {{"sharp_edges", creases->sharpEdges},
                        {"corner_vertices", creases->cornerVertices},
                        {"darts", creases->darts}};
    return all;
  }
  print("mesh " + object.name, input);
  print(object.mesh.attributes);
  if (const std::string lost = lossText(object.reading); !lost.empty())
    std::cout << "    reading           " << lost << '\n';
  const std::string dropped = summary(debris);
  if (!dropped.empty()) std::cout << "    debris            " << dropped << '\n';
  const std::string done = summary(report);
  const std::string split = summary(report.repair.faces);
  std::cout << "    repair            " << (done.empty() ? "none needed" : done) << '\n';
  if (!split.empty()) std::cout << "    faces             " << split << '\n';
  if (prepared.faces == 0)
    std::cout << "  after repair: nothing is left\n";
  else if (!done.empty() || !split.empty() || !dropped.empty())
    print(split.empty() ? "after repair" : "after repair and splitting", prepared);
  if (creases)
    std::cout << "    creases           " << counted(creases->sharpEdges, "sharp edge") << ", "
              << counted(creases->cornerVertices, "corner vertex", "corner vertices") << ", "
              << counted(creases->darts, "dart") << '\n';
  if (gaps.count > 0) std::cout << "    gaps              " << summary(gaps) << '\n';
  return {};
}

/// A value of metadata as one line; of many parts only the first.
std::string metadataText(const std::string& value) {
  constexpr std::size_t kMost = 300;
  if (value.size() <= kMost) return onOneLine(value);
  const std::size_t end = value.rfind(", ", kMost);
  return end == value.npos ? onOneLine(value) : onOneLine(value.substr(0, end)) + ", ...";
}

void print(const GridSummary& grid) {
  std::cout << "  grid " << grid.name << ": " << grid.type << ", " << grid.gridClass << '\n';
  std::cout << "    active voxels     " << grid.activeVoxels << " in " << grid.leaves << " leaves, "
            << grid.memoryBytes << " bytes in memory\n";
  if (grid.activeVoxels > 0)
    std::cout << "    box (index)       (" << grid.low[0] << ' ' << grid.low[1] << ' '
              << grid.low[2] << ") to (" << grid.high[0] << ' ' << grid.high[1] << ' '
              << grid.high[2] << ")\n";
  std::cout << "    voxel size        " << grid.voxelSize[0] << ' ' << grid.voxelSize[1] << ' '
            << grid.voxelSize[2] << '\n';
  if (grid.origin != std::array<double, 3>{})
    std::cout << "    voxel (0 0 0) at  " << grid.origin[0] << ' ' << grid.origin[1] << ' '
              << grid.origin[2] << '\n';
  for (const auto& [key, value] : grid.metadata)
    if (key.starts_with("vox_"))
      std::cout << "    " << std::left << std::setw(18) << key << metadataText(value) << '\n';
}

/// The meshes of a scene, as JSON or printed.
Json describe(const Scene& scene, const InfoArguments& options, bool json) {
  PreparationOptions preparation;
  preparation.weldTolerance = options.weldTolerance;
  preparation.smoothing.boundary = parseBoundary(options.boundary);
  preparation.smoothing.faces = parseFaces(options.faces);
  parseCreases(options.creases, preparation.smoothing);
  requirePreparable(scene, preparation);
  preparation.dropComponents = options.dropComponents;
  const std::vector<ObjectPreparation> prepared = preparationsOf(scene, preparation);
  Json meshes = Json::array();
  for (std::size_t i = 0; i < scene.objects.size(); ++i)
    meshes.push_back(describe(scene, i, prepared[i], json));
  return meshes;
}

Json describe(const std::string& file, const InfoArguments& options, bool json) {
  Json all = {{"file", file}};
  if (!json) std::cout << file << '\n';
  if (isGridFile(file)) {
    for (const GridSummary& grid : summarizeVdb(file)) {
      all["grids"].push_back(toJson(grid));
      if (!json) print(grid);
    }
    return all;
  }
  all["meshes"] = describe(readScene(file, options.scale), options, json);
  return all;
}

int runInfo(const InfoArguments& options) {
  Json all = Json::array();
  for (const std::string& file : options.files)
    all.push_back(describe(file, options, options.json));
  if (options.json) std::cout << textOf(all) << '\n';
  return 0;
}

}  // namespace

std::string infoJson(const InfoArguments& options, const Scene* input) {
  if (input != nullptr) {
    const Json meshes = {{"meshes", describe(*input, options, true)}};
    return textOf(meshes);
  }
  return textOf(describe(options.files.at(0), options, true));
}

void declareInfo(CLI::App& app, InfoArguments& options) {
  const Command command(app, "info",
                        "Print the contents of meshes, scenes and .vdb or .nvdb files");
  command
      .add("FILE", options.files,
           "Mesh, scene (.toml), OpenVDB file (.vdb) or NanoVDB file (.nvdb)")
      .required();
  command.addFlag("--json", options.json, "Print JSON");
  addScaleOption(command, options.scale);
  addBoundaryOption(command, options.boundary);
  addCreaseOptions(command, options.creases);
  addFacesOption(command, options.faces);
  addWeldOption(command, options.weldTolerance);
  addDropOption(command, options.dropComponents);
}

Action addInfo(CLI::App& app) {
  const auto options = std::make_shared<InfoArguments>();
  declareInfo(app, *options);
  return [options] { return runInfo(*options); };
}

}  // namespace vox::app
