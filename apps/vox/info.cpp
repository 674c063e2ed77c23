// vox info: what is in a mesh, scene or .vdb file.

#include "apps/vox/command.h"
#include "libvox/inspect/summary.h"
#include "libvox/io/input_file.h"
#include "libvox/io/scene_file.h"

#include <nlohmann/json.hpp>

#include <cstdio>
#include <iostream>
#include <memory>
#include <sstream>

namespace vox::app {
namespace {

using Json = nlohmann::ordered_json;

struct Options {
  std::vector<std::string> files;
  bool json = false;
};

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

Json toJson(const std::string& name, const MeshSummary& mesh) {
  const auto vector = [](const Vec3d& v) { return Json{v.x(), v.y(), v.z()}; };
  Json json = {{"name", name},
               {"vertices", mesh.points},
               {"edges", mesh.edges},
               {"faces", mesh.faces},
               {"components", mesh.components},
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
          {"metadata", grid.metadata}};
}

std::string histogramText(const std::map<std::uint64_t, std::uint64_t>& histogram) {
  std::ostringstream text;
  for (const auto& [value, count] : histogram)
    text << (text.tellp() > 0 ? ", " : "") << value << ": " << count;
  return text.str();
}

void print(const std::string& name, const MeshSummary& mesh) {
  std::cout << "  mesh " << name << ": " << mesh.points << " vertices, " << mesh.edges << " edges, "
            << mesh.faces << " faces, " << mesh.components
            << (mesh.components == 1 ? " component" : " components") << ", Euler characteristic "
            << mesh.eulerCharacteristic << '\n';
  std::cout << "    corners per face  " << histogramText(mesh.faceSizes) << '\n';
  std::cout << "    valence           " << histogramText(mesh.valences) << '\n';
  std::cout << "    box               (" << mesh.box.low.transpose() << ") to ("
            << mesh.box.high.transpose() << ")\n";
  if (mesh.boundaryLoops.empty()) {
    std::cout << "    boundary          none: closed\n";
  } else {
    std::uint64_t edges = 0;
    for (const auto loop : mesh.boundaryLoops) edges += loop;
    std::cout << "    boundary          " << mesh.boundaryLoops.size()
              << (mesh.boundaryLoops.size() == 1 ? " loop" : " loops") << " of " << edges
              << " edges in all\n";
  }
  for (const auto& [kind, count] : countByKind(mesh.defects))
    std::cout << "    defect            " << defectName(kind) << ": " << count << '\n';
  for (const Defect& defect : mesh.defects)
    if (!defect.message.empty()) std::cout << "      " << defect.message << '\n';
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
  for (const auto& [key, value] : grid.metadata)
    if (key.starts_with("vox_")) std::cout << "    " << key << "  " << value << '\n';
}

Json describe(const std::string& file, bool json) {
  Json all = {{"file", file}};
  if (!json) std::cout << file << '\n';
  if (lowerExtension(file) == ".vdb") {
    for (const GridSummary& grid : summarizeVdb(file)) {
      all["grids"].push_back(toJson(grid));
      if (!json) print(grid);
    }
    return all;
  }
  for (const SceneObject& object : readScene(file).objects) {
    const MeshSummary mesh = summarize(object.mesh);
    all["meshes"].push_back(toJson(object.name, mesh));
    if (!json) print(object.name, mesh);
  }
  return all;
}

int run(const Options& options) {
  Json all = Json::array();
  for (const std::string& file : options.files) all.push_back(describe(file, options.json));
  if (options.json) std::cout << all.dump(2, ' ', false, Json::error_handler_t::replace) << '\n';
  return 0;
}

}  // namespace

Action addInfo(CLI::App& app) {
  CLI::App* command = app.add_subcommand("info", "Print what is in meshes, scenes and .vdb files");
  const auto options = std::make_shared<Options>();
  command->add_option("FILE", options->files, "Mesh, scene (.toml) or OpenVDB file (.vdb)")
      ->required();
  command->add_flag("--json", options->json, "Print JSON");
  return [options] { return run(*options); };
}

}  // namespace vox::app
