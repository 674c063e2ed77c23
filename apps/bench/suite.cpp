#include "apps/bench/suite.h"

#include <stdexcept>

namespace vox::bench {
namespace {

struct MeshAtDim {
  std::string label;
  std::filesystem::path mesh;
  int dim;
};

Program peer(const Tools& tools, const std::string& name, const std::string& program,
             const MeshAtDim& input, const std::filesystem::path& output) {
  return {name,
          {(tools.peers / program).string(), input.mesh.string(), "-o", output.string(), "--dim",
           std::to_string(input.dim)}};
}

std::vector<Case> issueCases(const Tools& tools, const UserInput& user,
                             const std::filesystem::path& folder) {
  std::vector<MeshAtDim> inputs;
  if (!user.file.empty())
    inputs.push_back({std::filesystem::path(user.file).stem().string(),
                      meshNamed(tools, user.file, folder), user.dim});
  for (const auto& [name, dim] : std::vector<std::pair<std::string, int>>{
           {"torus", 2048}, {"cube", 1024}, {"triangles", 256}, {"triangles_graded", 256}})
    inputs.push_back({name, meshNamed(tools, name, folder), dim});

  std::vector<Case> cases;
  for (const MeshAtDim& input : inputs) {
    const Program vox = voxConvert(tools, input.mesh, input.dim, folder / "vox.vdb");
    const std::filesystem::path output = folder / "peer.vdb";
    for (const Program& other :
         {openvdbFloor(tools),
          peer(tools, "CGAL Doo-Sabin + rounding", "vox_peer_cgal", input, output),
          peer(tools, "naive, one thread", "vox_peer_naive", input, output)})
      cases.push_back({input.label + " at " + std::to_string(input.dim) + " against " + other.name,
                       vox, other});
  }
  return cases;
}

std::vector<Case> hardCases(const Tools& tools, const std::filesystem::path& folder) {
  constexpr int kDim = 2048;
  const auto voxOn = [&](const std::string& name) {
    Program vox = voxConvert(tools, meshNamed(tools, name, folder), kDim, folder / "vox.vdb");
    vox.name += " on " + name;
    return vox;
  };
  const Program torus = voxOn("torus");
  std::vector<Case> cases;
  for (const char* name : {"triangles", "triangles_shuffled", "triangles_graded", "cone", "prism",
                           "sliver", "graded", "quads"})
    cases.push_back(
        {std::string(name) + " at " + std::to_string(kDim) + " against torus", torus, voxOn(name)});
  return cases;
}

/// Scans against vdb_tool, which makes a level set of the mesh as it is.
std::vector<Case> scanCases(const Tools& tools, const std::filesystem::path& folder) {
  constexpr int kDim = 1024;
  std::vector<Case> cases;
  for (const char* name : {"scan_1m", "scan_4m", "scan_10m"}) {
    const std::filesystem::path mesh = meshNamed(tools, name, folder, ".ply");
    const Program mask = voxConvert(tools, mesh, kDim, folder / "vox.vdb");
    const Program levelSet{
        "vox convert, level set",
        {tools.vox.string(), "convert", mesh.string(), "-o", (folder / "vox.vdb").string(), "--dim",
         std::to_string(kDim), "--grids", "surface", "--force"}};
    const Program tool{"vdb_tool -mesh2ls",
                       {"vdb_tool", "-quiet", "-read", mesh.string(), "-mesh2ls",
                        "dim=" + std::to_string(kDim), "-write", (folder / "tool.vdb").string()}};
    const std::string at = " at " + std::to_string(kDim) + " against vdb_tool";
    cases.push_back({name + (", mask" + at), mask, tool});
    cases.push_back({name + (", level set" + at), levelSet, tool});
  }
  const Program ordered =
      voxConvert(tools, meshNamed(tools, "scan_4m", folder, ".ply"), kDim, folder / "vox.vdb");
  Program random = voxConvert(tools, meshNamed(tools, "scan_4m_shuffled", folder, ".ply"), kDim,
                              folder / "vox.vdb");
  random.name += ", random order";
  cases.push_back({"scan_4m in order against random order", ordered, random});
  return cases;
}

}  // namespace

Tools toolsBeside(const std::filesystem::path& self) {
  const std::filesystem::path folder = self.parent_path();
  return {folder.parent_path() / "vox" / "vox", folder / "vox_bench_inputs_write",
          folder / "peers"};
}

Program voxConvert(const Tools& tools, const std::filesystem::path& mesh, int dim,
                   const std::filesystem::path& output, const std::vector<std::string>& more) {
  Program program{"vox convert",
                  {tools.vox.string(), "convert", mesh.string(), "-o", output.string(), "--dim",
                   std::to_string(dim), "--grids", "mask", "--force"}};
  program.command.insert(program.command.end(), more.begin(), more.end());
  return program;
}

Program openvdbFloor(const Tools& tools) {
  return {"loading OpenVDB alone", {(tools.peers / "vox_peer_floor").string()}};
}

std::filesystem::path meshNamed(const Tools& tools, const std::string& name,
                                const std::filesystem::path& folder, const char* extension) {
  if (std::filesystem::is_regular_file(name)) return name;
  const std::filesystem::path file = folder / (name + extension);
  if (std::filesystem::exists(file)) return file;
  const ProcessRun run = runProcess({tools.inputsWriter.string(), name, file.string()}, {});
  if (run.outcome != Outcome::kOk)
    throw std::runtime_error(name + ": neither a file nor written by " +
                             tools.inputsWriter.string() + ", which " + describe(run));
  return file;
}

const std::vector<std::string>& suiteNames() {
  static const std::vector<std::string> names = {"issue", "hard", "scan"};
  return names;
}

std::vector<Case> suiteCases(const std::string& name, const Tools& tools, const UserInput& user,
                             const std::filesystem::path& folder) {
  if (name == "issue") return issueCases(tools, user, folder);
  if (name == "hard") return hardCases(tools, folder);
  if (name == "scan") return scanCases(tools, folder);
  throw std::invalid_argument("no suite is named '" + name + "'");
}

}  // namespace vox::bench
