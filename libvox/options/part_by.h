#pragma once

#include "libvox/core/names.h"

namespace vox {

/// What the parts of a model are: the sets of faces that the grid `part` tells apart.
enum class PartBy {
  kObject,    ///< objects of the scene, and named objects of mesh files
  kGroup,     ///< groups of mesh files
  kMaterial,  ///< materials of mesh files
};
inline constexpr NameTable<PartBy, 3> kPartByNames = {
    {{PartBy::kObject, "object"}, {PartBy::kGroup, "group"}, {PartBy::kMaterial, "material"}}};

}  // namespace vox
