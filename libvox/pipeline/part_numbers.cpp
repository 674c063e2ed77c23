// Names and numbers of parts.

#include "libvox/pipeline/part_numbers.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <unordered_set>
#include <utility>

namespace vox {
namespace {

const FaceSets& setsOf(const PolygonMesh& mesh, PartBy by) {
  switch (by) {
    case PartBy::kGroup:
      return mesh.attributes.groups;
    case PartBy::kMaterial:
      return mesh.attributes.materials;
    case PartBy::kObject:
      break;
  }
  return mesh.attributes.objects;
}

/// The name of a set of faces of an object; kNone: of its faces without a set.
std::string nameOf(const SceneObject& object, PartBy by, Index set, bool severalObjects) {
  if (set == kNone) return object.name;
  const std::string& name = setsOf(object.mesh, by).names[set];
  return by == PartBy::kObject && severalObjects ? object.name + "/" + name : name;
}

/// True if a scene has two parts or more.
bool tellsApart(const Scene& scene, PartBy by) {
  std::unordered_set<std::string> names;
  for (const SceneObject& object : scene.objects) {
    const FaceSets& sets = setsOf(object.mesh, by);
    const bool several = scene.objects.size() > 1;
    for (Index set = 0; set < sets.names.size(); ++set)
      names.insert(nameOf(object, by, set, several));
    if (sets.empty() ||
        std::find(sets.ofFaces.begin(), sets.ofFaces.end(), kNone) != sets.ofFaces.end())
      names.insert(object.name);
    if (names.size() > 1) return true;
  }
  return false;
}

PartBy ruleFor(const Scene& scene) {
  for (const PartBy by : {PartBy::kObject, PartBy::kGroup, PartBy::kMaterial})
    if (tellsApart(scene, by)) return by;
  return PartBy::kObject;
}

}  // namespace

PartNumbers::PartNumbers(const Scene& scene, std::optional<PartBy> by)
    : severalObjects_(scene.objects.size() > 1), by_(by ? *by : ruleFor(scene)) {}

std::int32_t PartNumbers::numberOf(const std::string& name) {
  const auto [found, isNew] =
      numbers_.try_emplace(name, static_cast<std::int32_t>(names_.size() + 1));
  if (isNew) names_.push_back(name);
  return found->second;
}

std::vector<std::int32_t> PartNumbers::ofFaces(const SceneObject& object,
                                               const std::vector<Index>& faceOrigin) {
  const FaceSets& sets = setsOf(object.mesh, by_);
  std::vector<std::int32_t> ofSets(sets.names.size(), 0);  // 0: not known yet
  std::int32_t ofObject = 0;
  std::vector<std::int32_t> parts;
  parts.reserve(faceOrigin.size());
  for (const Index f : faceOrigin) {
    const Index set = sets.empty() ? kNone : sets.ofFaces[f];
    std::int32_t& number = set == kNone ? ofObject : ofSets[set];
    if (number == 0) number = numberOf(nameOf(object, by_, set, severalObjects_));
    parts.push_back(number);
  }
  return parts;
}

std::string partNamesText(const std::vector<std::string>& names) {
  nlohmann::ordered_json text = nlohmann::ordered_json::object();
  for (std::size_t n = 0; n < names.size(); ++n) text[std::to_string(n + 1)] = names[n];
  return text.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);
}

}  // namespace vox
