// Which part each face of a scene belongs to, and what the parts are called.

#include "libvox/pipeline/parts.h"

#include "libvox/core/error.h"
#include "libvox/options/volume_options.h"

#include <nlohmann/json.hpp>

#include <cstddef>
#include <limits>
#include <unordered_map>
#include <utility>

namespace vox {
namespace {

/// Gives numbers to names.
class PartNumbers {
 public:
  explicit PartNumbers(Parts& parts) : parts_(parts) {}

  std::int32_t of(const std::string& name) {
    const auto [known, isNew] = numbers_.try_emplace(name, parts_.names.size() + 1);
    if (isNew) parts_.names.push_back(name);
    if (known->second > std::size_t{std::numeric_limits<std::int32_t>::max()})
      throw LimitError("the input has too many parts; choose others with --part-by");
    return static_cast<std::int32_t>(known->second);
  }
  /// From now on, other parts may have the same names.
  void forget() { numbers_.clear(); }

 private:
  Parts& parts_;
  std::unordered_map<std::string, std::size_t> numbers_;
};

const FaceSets& setsOf(const MeshAttributes& attributes, PartBy by) {
  if (by == PartBy::kObject) return attributes.objects;
  return by == PartBy::kGroup ? attributes.groups : attributes.materials;
}

std::string quoted(const std::string& name) {
  using Json = nlohmann::json;
  constexpr int kOneLine = -1;
  return Json(name).dump(kOneLine, ' ', /*ensure_ascii=*/false, Json::error_handler_t::replace);
}

bool isLetterOrDigit(char c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
}

std::string asGridName(const std::string& name) {
  std::string grid;
  for (const char c : name) grid += isLetterOrDigit(c) ? c : '_';
  return grid.empty() || (grid[0] >= '0' && grid[0] <= '9') ? "_" + grid : grid;
}

}  // namespace

Parts partsOf(const Scene& scene, PartBy by) {
  Parts parts;
  PartNumbers numbers(parts);
  for (const SceneObject& object : scene.objects) {
    const FaceSets& sets = setsOf(object.mesh.attributes, by);
    if (by == PartBy::kObject) numbers.forget();
    const bool isPrefixed = by == PartBy::kObject && scene.objects.size() > 1;
    constexpr std::int32_t kUnknown = 0;
    std::vector<std::int32_t> partOfSet(sets.names.size() + 1, kUnknown);  // at last: of no set
    std::vector<std::int32_t>& ofFaces = parts.ofFaces.emplace_back();
    ofFaces.reserve(object.mesh.faceCount());
    for (Index f = 0; f < object.mesh.faceCount(); ++f) {
      const Index set = sets.empty() ? kNone : sets.ofFaces[f];
      std::int32_t& part = set == kNone ? partOfSet.back() : partOfSet[set];
      if (part == kUnknown)
        part = numbers.of(set == kNone ? object.name
                          : isPrefixed ? object.name + "/" + sets.names[set]
                                       : sets.names[set]);
      ofFaces.push_back(part);
    }
  }
  return parts;
}

PartBy defaultPartBy(const Scene& scene) {
  for (const auto& [by, name] : kPartByNames)
    if (partsOf(scene, by).names.size() > 1) return by;
  return PartBy::kObject;
}

std::string partsJson(const std::vector<std::string>& names) {
  std::string json;
  for (std::size_t i = 0; i < names.size(); ++i)
    json += (i > 0 ? ", \"" : "\"") + std::to_string(i + 1) + "\": " + quoted(names[i]);
  return "{" + json + "}";
}

std::string textOfName(const std::string& name) {
  return nlohmann::json::parse(quoted(name)).get<std::string>();
}

std::vector<std::string> gridNamesOfParts(const std::vector<std::string>& names) {
  std::unordered_map<std::string, std::size_t> uses;  // of names that are taken
  for (const auto& [kind, name] : kGridNames)
    for (const Target target : {Target::kBlender, Target::kHoudini})
      uses[gridNameFor(kind, target)] = 1;
  std::vector<std::string> grids;
  grids.reserve(names.size());
  for (const std::string& name : names) {
    const std::string wanted = asGridName(name);
    const auto sameNamed = uses.find(wanted);
    std::string unique = wanted;
    while (uses.contains(unique)) unique = wanted + "_" + std::to_string(++sameNamed->second);
    uses[unique] = 1;
    grids.push_back(unique);
  }
  return grids;
}

}  // namespace vox
