#pragma once

#include "libvox/core/types.h"
#include "libvox/mesh/material.h"

#include <string>
#include <vector>

namespace vox {

/// Named sets of faces. A face is in one of them or in none.
struct FaceSets {
  std::vector<std::string> names;
  std::vector<Index> ofFaces;  ///< F numbers of names, or kNone; or empty: no face is in a set

  bool empty() const { return ofFaces.empty(); }
};

/// What the faces of a mesh and their corners carry besides positions and colours.
struct MeshAttributes {
  /// C texture coordinates of corners, or empty. A corner without has NaN.
  std::vector<Vec2f> texcoords;
  FaceSets objects;                  ///< what a file calls objects or nodes
  FaceSets groups;                   ///< what it calls groups
  FaceSets materials;                ///< its names of materials
  std::vector<Material> looks = {};  ///< one for each name of `materials`, or empty
};

}  // namespace vox
