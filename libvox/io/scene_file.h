#pragma once

#include "libvox/mesh/polygon_mesh.h"
#include "libvox/options/grid_kind.h"
#include "libvox/options/smoothing_options.h"
#include "libvox/options/stop_rule.h"
#include "libvox/options/texture_spec.h"
#include "libvox/options/volume_options.h"
#include "libvox/options/voxelize.h"

#include <Eigen/Geometry>

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vox {

struct SceneObject {
  std::string name;
  PolygonMesh mesh;  ///< world units, the object's transform applied
  SmoothingOptions smoothing = {};
  std::optional<StopRule> until = {};
  std::optional<Voxelize> voxelize = {};
  std::optional<TextureSpec> texture = {};
  Eigen::Affine3d fromWorld = Eigen::Affine3d::Identity();  ///< undoes the object's transform
};

/// What to convert, and how, as far as the scene says.
struct Scene {
  std::optional<int> dim;           ///< [convert] dim: voxels along the longest side
  std::optional<double> voxelSize;  ///< [convert] voxel_size: world units
  std::optional<std::vector<GridKind>> grids;
  std::optional<double> weldTolerance;       ///< [convert] weld: world units
  std::optional<bool> strict;                ///< [convert] strict: no repair
  VolumeOptions volume;                      ///< [convert] fill and what else it has
  std::optional<StopRule> until;             ///< [convert] until: of objects that say nothing
  std::optional<Voxelize> voxelize;          ///< [convert] voxelize: likewise
  std::vector<SceneObject> objects;          ///< at least one
  std::vector<std::filesystem::path> files;  ///< the input file, then the meshes it names
  std::string inputHash;  ///< of the contents of these files; empty if there are none
};

/// Reads a scene file (.toml, DESIGN section 11), or a mesh file as a scene of one object.
///
/// Paths in a scene are relative to its folder. A transform scales, then rotates about x, y and z
/// (degrees, in this order, counter-clockwise seen from the tip of the axis), then translates;
/// where it mirrors, the faces are turned round so that they stay outward.
///
/// @throws InputError  unreadable or malformed; unknown keys and wrong types are named as
///   "FILE:LINE:COLUMN: ..."
Scene readScene(const std::filesystem::path& file);

/// The same from the content of a scene file; the name stands in messages and gives the folder.
Scene parseScene(const std::filesystem::path& file, std::string_view content);

}  // namespace vox
