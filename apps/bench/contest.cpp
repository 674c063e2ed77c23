#include "apps/bench/contest.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <iomanip>
#include <sstream>
#include <stdexcept>

namespace vox::bench {
namespace {

constexpr const char* kVertices = "vox, vertices";
constexpr const char* kPolygons = "vox, polygons, 6-separating";
constexpr const char* kPolygons26 = "vox, polygons, 26-separating";
constexpr const char* kLevelSet = "vox, level set";

struct MeshFacts {
  double longestSide = 0;
  double faces = 0;
};

MeshFacts factsOf(const Tools& tools, const std::filesystem::path& mesh) {
  const ProcessRun run = runProcess({tools.vox.string(), "info", "--json", mesh.string()}, {});
  if (run.outcome != Outcome::kOk) throw std::runtime_error(mesh.string() + ": " + describe(run));
  const auto facts = nlohmann::json::parse(run.output).at(0).at("meshes").at(0);
  MeshFacts result{0, facts.at("faces").get<double>()};
  for (std::size_t axis = 0; axis < 3; ++axis)
    result.longestSide = std::max(result.longestSide, facts.at("high").at(axis).get<double>() -
                                                          facts.at("low").at(axis).get<double>());
  return result;
}

/// Levels at which faces measure some voxels: those of a sphere of as many voxels across, say 3 d^2
/// of them, would be of 6.
int levelsFor(const MeshFacts& facts, int dim) {
  double faces = facts.faces;
  int levels = 0;
  for (; faces < 0.5 * dim * dim; ++levels) faces *= 4;
  return levels;
}

class Inputs {
 public:
  Inputs(const Tools& tools, const std::filesystem::path& mesh, const std::filesystem::path& folder)
      : tools_(tools), mesh_(mesh), folder_(folder), facts_(factsOf(tools, mesh)) {}

  std::vector<Program> programs(int dim) const {
    const auto vox = [&](const char* name, const std::vector<std::string>& more) {
      Program program = voxConvert(tools_, mesh_, dim, output(name), more);
      program.name = name;
      return program;
    };
    const std::vector<std::string> polygons = {"--voxelize", "polygon", "--until", "flatness=0.1"};
    auto polygons26 = polygons;
    polygons26.insert(polygons26.end(), {"--separating", "26"});
    const std::string levels = std::to_string(levelsFor(facts_, dim));
    std::ostringstream digits;
    digits << std::setprecision(17) << facts_.longestSide / dim;
    const std::string voxelSize = digits.str();
    return {
        vox(kVertices, {"--voxelize", "vertex"}),
        vox(kPolygons, polygons),
        vox(kPolygons26, polygons26),
        levelSet(dim),
        cgal("CGAL Doo-Sabin, rounding", dim, "mask"),
        cgal("CGAL Doo-Sabin, meshToVolume unsigned", dim, "unsigned"),
        cgal("CGAL Doo-Sabin, meshToVolume level set", dim, "level-set"),
        {"vdb_tool -mesh2ls of a refined mesh",
         {"vdb_tool", "-read", refined(dim).string(), "-mesh2ls", "voxel=" + voxelSize, "-write",
          output("vdb_tool -mesh2ls of a refined mesh")}},
        {"Blender, Mesh to Volume",
         {"blender", "--background", "--factory-startup", "--python",
          (tools_.peers / "blender_volume.py").string(), "--", mesh_.string(),
          output("Blender, Mesh to Volume"), levels, voxelSize}},
        {"OpenSubdiv, refinement only",
         {(tools_.peers / "vox_peer_opensubdiv").string(), mesh_.string(), "--levels", levels}},
    };
  }

  /// The file that a program writes.
  std::string output(const std::string& program) const {
    std::string name = program;
    std::replace(name.begin(), name.end(), ' ', '_');
    return (folder_ / (name + ".vdb")).string();
  }

  /// Writes what programs read; its time is nobody's.
  void prepare(int dim) const {
    runProcess({tools_.vox.string(), "subdivide", mesh_.string(), "--levels",
                std::to_string(levelsFor(facts_, dim)), "-o", refined(dim).string()},
               {});
  }
  void tidy(int dim) const { std::filesystem::remove(refined(dim)); }

 private:
  std::filesystem::path refined(int dim) const {
    return folder_ / ("refined" + std::to_string(dim) + ".obj");
  }
  Program levelSet(int dim) const {
    return {kLevelSet,
            {tools_.vox.string(), "convert", mesh_.string(), "-o", output(kLevelSet), "--dim",
             std::to_string(dim), "--grids", "surface", "--force"}};
  }
  Program cgal(const char* name, int dim, const char* kind) const {
    return {name,
            {(tools_.peers / "vox_peer_cgal").string(), mesh_.string(), "-o", output(name), "--dim",
             std::to_string(dim), "--as", kind}};
  }

  const Tools& tools_;
  std::filesystem::path mesh_;
  std::filesystem::path folder_;
  MeshFacts facts_;
};

std::vector<Contender> newContenders() {
  return {{kVertices, ""},
          {kPolygons, ""},
          {kPolygons26, ""},
          {kLevelSet, ""},
          {"CGAL Doo-Sabin, rounding", kVertices},
          {"CGAL Doo-Sabin, meshToVolume unsigned", kPolygons26},
          {"CGAL Doo-Sabin, meshToVolume level set", kLevelSet},
          {"vdb_tool -mesh2ls of a refined mesh", kLevelSet},
          {"Blender, Mesh to Volume", kLevelSet},
          {"OpenSubdiv, refinement only", kVertices}};
}

/// Looks at the file of a program, and takes it away.
Output takeOutput(const Tools& tools, const std::filesystem::path& file) {
  Output output;
  if (!std::filesystem::exists(file)) return output;
  output.fileBytes = static_cast<double>(std::filesystem::file_size(file));
  const ProcessRun run = runProcess({tools.vox.string(), "info", "--json", file.string()}, {});
  if (run.outcome == Outcome::kOk) {
    output.voxels = 0;
    const auto facts = nlohmann::json::parse(run.output);
    for (const auto& grid : facts.at(0).at("grids"))
      *output.voxels += grid.at("active_voxels").get<std::uint64_t>();
  }
  std::filesystem::remove(file);
  return output;
}

bool goesOn(const Contender& contender) {
  return contender.sides.empty() || (contender.sides.back() && contender.sides.back()->ok());
}

}  // namespace

Contest holdContest(const Tools& tools, const std::string& input, const std::vector<int>& dims,
                    int runs, const Limits& limits, const std::filesystem::path& folder,
                    const Progress& progress) {
  const Inputs inputs(tools, meshNamed(tools, input, folder), folder);
  Contest contest{input, dims, newContenders()};
  std::sort(contest.dims.begin(), contest.dims.end());
  for (const int dim : contest.dims) {
    std::vector<Program> running;
    for (const Program& program : inputs.programs(dim))
      for (const Contender& contender : contest.contenders)
        if (contender.name == program.name && goesOn(contender)) running.push_back(program);
    inputs.prepare(dim);
    std::vector<Side> sides =
        measureInTurn(input + " at " + std::to_string(dim), running, runs, limits, progress);
    inputs.tidy(dim);
    for (Contender& contender : contest.contenders) {
      contender.outputs.push_back(takeOutput(tools, inputs.output(contender.name)));
      const auto side = std::find_if(sides.begin(), sides.end(), [&](const Side& one) {
        return one.program.name == contender.name;
      });
      contender.sides.push_back(side == sides.end() ? std::optional<Side>() : std::move(*side));
    }
  }
  return contest;
}

}  // namespace vox::bench
