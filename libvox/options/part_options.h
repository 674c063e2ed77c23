#pragma once

#include "libvox/core/names.h"

namespace vox {

/// What a part of the input is.
enum class PartBy {
  kObject,    ///< an object of the scene; within it, what its mesh file calls objects or nodes
  kGroup,     ///< a group of faces
  kMaterial,  ///< the faces of a material
};
inline constexpr NameTable<PartBy, 3> kPartByNames = {
    {{PartBy::kObject, "object"}, {PartBy::kGroup, "group"}, {PartBy::kMaterial, "material"}}};

/// Into which parts the grid `density` is split, a grid each.
enum class Split {
  kPart,    ///< the parts of the grid `part`
  kObject,  ///< the same with PartBy::kObject
};
inline constexpr NameTable<Split, 2> kSplitNames = {
    {{Split::kPart, "part"}, {Split::kObject, "object"}}};

/// Name of the metadata, of a grid that holds one part of a density, with the name of the part.
inline constexpr const char* kPartNameMetadata = "vox_part_name";

}  // namespace vox
