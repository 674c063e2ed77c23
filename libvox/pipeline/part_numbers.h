#pragma once

#include "libvox/io/scene_file.h"
#include "libvox/options/part_by.h"

#include <cstdint>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

namespace vox {

/// The numbers of the parts of a scene, from 1 in the order in which faces have them. A part is
/// what has one name: a set of faces of a mesh, or an object for its faces without a set.
class PartNumbers {
 public:
  /// @param by  nothing: the first of object, group and material that tells two parts apart, else
  ///   object
  PartNumbers(const Scene& scene, std::optional<PartBy> by);

  /// The part of each prepared face of an object.
  /// @param faceOrigin  per prepared face: the face of the object's mesh
  std::vector<std::int32_t> ofFaces(const SceneObject& object,
                                    const std::vector<Index>& faceOrigin);

  /// The names of the numbers 1, 2, ...
  const std::vector<std::string>& names() const { return names_; }

 private:
  std::int32_t numberOf(const std::string& name);

  bool severalObjects_;
  PartBy by_;
  std::vector<std::string> names_;
  std::unordered_map<std::string, std::int32_t> numbers_;
};

/// Names as JSON: {"1": "body", "2": "left arm"}. Bytes that are no UTF-8 are replaced.
std::string partNamesText(const std::vector<std::string>& names);

}  // namespace vox
