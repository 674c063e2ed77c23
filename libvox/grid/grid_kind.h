#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vox {

/// The grids a conversion can make (DESIGN section 9).
enum class GridKind {
  kDensity,  ///< Float fog volume, 1 at black voxels
  kMask,     ///< the black voxels
  kNormal,   ///< Vec3s, unit normals of the surface at black voxels
  kColor,    ///< Vec3s, linear colour of black voxels
  kSurface,  ///< Float level set, narrow band of distances to the surface
};

/// Name in scenes and on the command line: "density".
std::string gridName(GridKind kind);

/// Grid of that name, or nothing.
std::optional<GridKind> gridNamed(std::string_view name);

/// "density, mask, surface, normal, color": for messages.
std::string allGridNames();

}  // namespace vox
