#pragma once

#include "libvox/core/names.h"
#include "libvox/core/types.h"

namespace vox {

/// How a surface is cut into submeshes (paper section 4). kBefore and kDuring give the same voxels,
/// whatever the size of the submeshes.
enum class Localize {
  kBefore,  ///< submeshes of the prepared mesh, a task each
  kDuring,  ///< the same, and patches that have become large are split into tasks of their own
  kOff,     ///< the whole mesh level by level: the plain algorithm, for comparison
};
inline constexpr NameTable<Localize, 3> kLocalizeNames = {
    {{Localize::kBefore, "before"}, {Localize::kDuring, "during"}, {Localize::kOff, "off"}}};

/// Faces of a submesh: small enough for its level 1 to stay in the second-level cache, large enough
/// for its one-ring to cost little.
inline constexpr Index kDefaultSubmeshFaces = 256;

struct SurfaceOptions {
  Localize localize = Localize::kDuring;
  Index submeshFaces = kDefaultSubmeshFaces;
};

}  // namespace vox
