#pragma once

#include "libvox/core/names.h"

namespace vox {

/// The grids a conversion can make (DESIGN section 9).
enum class GridKind {
  kDensity,  ///< Float fog volume, 1 at black voxels
  kMask,     ///< the black voxels
  kNormal,   ///< Vec3s, unit normals of the surface at black voxels
  kColor,    ///< Vec3s, linear colour of black voxels
  kSurface,  ///< Float level set, narrow band of distances to the surface
};
inline constexpr NameTable<GridKind, 5> kGridNames = {{{GridKind::kDensity, "density"},
                                                       {GridKind::kMask, "mask"},
                                                       {GridKind::kSurface, "surface"},
                                                       {GridKind::kNormal, "normal"},
                                                       {GridKind::kColor, "color"}}};

}  // namespace vox
