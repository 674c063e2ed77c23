#include "apps/bench/contest.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <iomanip>
#include <sstream>
#include <stdexcept>

namespace vox::bench {
namespace {

/// A program of the contest, and the name of the vox contender that makes the same grid.
struct Entry {
  Program program;
  std::string against = {};
};

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

/// Number of subdivision levels after which faces are a few voxels in size: at least dim^2 / 2
/// faces. (A sphere has about 3 dim^2 voxels: 6 voxels per face.)
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

  std::vector<Entry> entries(int dim) const {
    const std::string vertices = "vox, vertices";
    const std::string polygons26 = "vox, polygons, 26-separating";
    const std::string levelSet = "vox, level set";
    const std::string vdbTool = "vdb_tool -mesh2ls of a refined mesh";
    const std::string blender = "Blender, Mesh to Volume";
    const std::string levels = std::to_string(levelsFor(facts_, dim));
    std::ostringstream digits;
    digits << std::setprecision(17) << facts_.longestSide / dim;
    const std::string voxelSize = digits.str();
    return {
        vox(vertices, dim, {"--voxelize", "vertex"}),
        vox("vox, polygons, 6-separating", dim,
            {"--voxelize", "polygon", "--until", "flatness=0.1"}),
        vox(polygons26, dim,
            {"--voxelize", "polygon", "--until", "flatness=0.1", "--separating", "26"}),
        vox(levelSet, dim, {}, "surface"),
        {cgal("CGAL Doo-Sabin, rounding", dim, "mask"), vertices},
        {cgal("CGAL Doo-Sabin, meshToVolume unsigned", dim, "unsigned"), polygons26},
        {cgal("CGAL Doo-Sabin, meshToVolume level set", dim, "level-set"), levelSet},
        {{vdbTool,
          {"vdb_tool", "-read", refined(dim).string(), "-mesh2ls", "voxel=" + voxelSize, "-write",
           output(vdbTool)}},
         levelSet},
        {{blender,
          {"blender", "--background", "--factory-startup", "--python",
           (tools_.peers / "blender_volume.py").string(), "--", mesh_.string(), output(blender),
           levels, voxelSize}},
         levelSet},
        {{"OpenSubdiv, refinement only",
          {(tools_.peers / "vox_peer_opensubdiv").string(), mesh_.string(), "--levels", levels}},
         vertices},
    };
  }

  /// Name of the file that a program writes.
  std::string output(const std::string& program) const {
    std::string name = program;
    std::replace(name.begin(), name.end(), ' ', '_');
    return (folder_ / (name + ".vdb")).string();
  }

  /// Writes the files that programs read. This time is not counted.
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
  Entry vox(const std::string& name, int dim, const std::vector<std::string>& more,
            const char* grids = "mask") const {
    Entry entry{{name,
                 {tools_.vox.string(), "convert", mesh_.string(), "-o", output(name), "--dim",
                  std::to_string(dim), "--grids", grids, "--force"}}};
    entry.program.command.insert(entry.program.command.end(), more.begin(), more.end());
    return entry;
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

/// Facts about the file that a program has written; removes the file.
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
  Contest contest{input, dims, {}};
  std::sort(contest.dims.begin(), contest.dims.end());
  for (const Entry& entry : inputs.entries(contest.dims.front()))
    contest.contenders.push_back({entry.program.name, entry.against});
  for (const int dim : contest.dims) {
    std::vector<Program> running;
    const std::vector<Entry> entries = inputs.entries(dim);
    for (std::size_t i = 0; i < entries.size(); ++i)
      if (goesOn(contest.contenders[i])) running.push_back(entries[i].program);
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
