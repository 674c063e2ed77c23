#pragma once

#include "libvox/mesh/mesh_attributes.h"

#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

namespace vox {

/// Collects named sets of faces while a file is read: each statement names the set of the faces
/// that follow it.
class FaceSetBuilder {
 public:
  /// @param faceCount  number of faces read so far
  void begin(const std::string& name, Index faceCount) {
    closeAt(faceCount);
    const auto [found, isNew] = numbers_.try_emplace(name, static_cast<Index>(sets_.names.size()));
    if (isNew) sets_.names.push_back(name);
    current_ = found->second;
  }

  /// The sets of all faces; none if no face is in a set. Names without a face stay out.
  FaceSets take(Index faceCount) {
    if (sets_.names.empty()) return {};
    closeAt(faceCount);
    std::vector<Index> newNumber(sets_.names.size(), kNone);
    FaceSets used;
    for (Index& set : sets_.ofFaces) {
      if (set == kNone) continue;
      if (newNumber[set] == kNone) {
        newNumber[set] = static_cast<Index>(used.names.size());
        used.names.push_back(sets_.names[set]);
      }
      set = newNumber[set];
    }
    if (!used.names.empty()) used.ofFaces = std::move(sets_.ofFaces);
    return used;
  }

 private:
  /// The faces since the last statement are in the current set.
  void closeAt(Index faceCount) { sets_.ofFaces.resize(faceCount, current_); }

  FaceSets sets_;
  std::unordered_map<std::string, Index> numbers_;
  Index current_ = kNone;
};

}  // namespace vox
