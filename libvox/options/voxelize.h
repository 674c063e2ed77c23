#pragma once

#include "libvox/core/names.h"

namespace vox {

/// How polygons or vertices become voxels.
enum class Voxelize {
  kAuto,     ///< by vertices where these can do it, else by polygons
  kVertex,   ///< every vertex switches on its voxel
  kPolygon,  ///< polygons are scan-converted
};
inline constexpr NameTable<Voxelize, 3> kVoxelizeNames = {
    {{Voxelize::kAuto, "auto"}, {Voxelize::kVertex, "vertex"}, {Voxelize::kPolygon, "polygon"}}};

/// Which paths of inactive voxels the active voxels of a surface stop: those from face to face (6),
/// or those through edges and corners too (26).
enum class Separation { k6, k26 };
inline constexpr NameTable<Separation, 2> kSeparationNames = {
    {{Separation::k6, "6"}, {Separation::k26, "26"}}};

}  // namespace vox
