#pragma once

#include "libvox/core/names.h"

namespace vox {

/// The grids that a conversion can make (DESIGN section 14). "Active" are the voxels of the
/// surface.
enum class GridKind {
  kDensity,  ///< Float fog volume, constant at active voxels
  kMask,     ///< the active voxels
  kNormal,   ///< Vec3s, unit normals of the surface at active voxels
  kColor,    ///< Vec3s, linear colour of active voxels
  kSurface,  ///< Float level set: narrow band of distances to the surface
  kPart,     ///< Int32, number of the part that a voxel belongs to, from 1
};
inline constexpr NameTable<GridKind, 6> kGridNames = {{{GridKind::kDensity, "density"},
                                                       {GridKind::kMask, "mask"},
                                                       {GridKind::kSurface, "surface"},
                                                       {GridKind::kNormal, "normal"},
                                                       {GridKind::kColor, "color"},
                                                       {GridKind::kPart, "part"}}};

}  // namespace vox
