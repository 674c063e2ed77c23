// The material files of a mesh.

#include "libvox/io/read_materials.h"

#include "libvox/core/error.h"
#include "libvox/io/companion_file.h"
#include "libvox/io/read_mtl.h"
#include "libvox/io/text_scanner.h"

#include <sstream>
#include <string>
#include <string_view>
#include <system_error>
#include <unordered_map>
#include <unordered_set>
#include <vector>

namespace vox {
namespace {

namespace fs = std::filesystem;

/// The files of lines, each of them once. Names may have blanks, so a line is one name if such a
/// file exists.
std::vector<fs::path> filesOf(const fs::path& folder, const std::vector<std::string>& lines) {
  std::vector<fs::path> files;
  std::unordered_set<std::string> known;
  const auto add = [&](const fs::path& file) {
    if (known.insert(file.string()).second) files.push_back(file);
  };
  for (const std::string& line : lines) {
    const auto found = [&](std::string_view name) {
      return foundCompanion(companionPath(name, folder), folder);
    };
    const fs::path whole = found(line);
    std::error_code ignored;
    if (fs::exists(whole, ignored)) {
      add(whole);
      continue;
    }
    std::istringstream words(line);
    for (std::string word; words >> word;) add(found(word));
  }
  return files;
}

}  // namespace

void readMaterials(const fs::path& meshFile, PolygonMesh& mesh, ReadReport& report) {
  const std::vector<std::string>& lines = report.materialFiles;
  const std::vector<std::string>& names = mesh.attributes.materials.names;
  if (lines.empty() || names.empty()) return;
  std::unordered_map<std::string, Material> known;
  for (const fs::path& file : filesOf(meshFile.parent_path(), lines)) {
    try {
      for (Material& material : readMtl(file)) known.try_emplace(material.name, material);
      report.companions.push_back(file.string());
    } catch (const InputError& error) {
      report.materialProblems.push_back(std::string(error.what()) + "; its materials are not used");
    }
  }
  for (const std::string& name : names) {
    const auto found = known.find(name);
    if (found == known.end() && report.materialProblems.empty())
      report.materialProblems.push_back(report.file + ": the material " + quote(name) +
                                        " is in none of its material files");
    Material& look = mesh.attributes.looks.emplace_back();
    if (found != known.end()) look = found->second;
    look.name = name;
  }
  if (known.empty()) mesh.attributes.looks.clear();
}

}  // namespace vox
