#pragma once

#include "libvox/io/read_report.h"
#include "libvox/mesh/polygon_mesh.h"
#include "libvox/options/component_limit.h"
#include "libvox/options/grid_kind.h"
#include "libvox/options/part_options.h"
#include "libvox/options/smoothing_options.h"
#include "libvox/options/stop_rule.h"
#include "libvox/options/texture_spec.h"
#include "libvox/options/volume_options.h"
#include "libvox/options/voxelize.h"

#include <Eigen/Geometry>

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace vox {

/// One object of a scene. Options without a value are not set.
struct SceneObject {
  std::string name;
  PolygonMesh mesh;  ///< world space; transform of the object and scale have been applied
  SmoothingOptions smoothing = {};
  std::optional<StopRule> until = {};
  std::optional<Voxelize> voxelize = {};
  std::optional<TextureSpec> texture = {};
  std::optional<ComponentLimit> dropComponents = {};
  Eigen::Affine3d fromWorld = Eigen::Affine3d::Identity();  ///< inverse of both
  ReadReport reading = {};                                  ///< oddities of the mesh file
};

/// Objects to convert, and the options of the scene. Options without a value are not set.
struct Scene {
  std::optional<int> dim;                       ///< [convert] dim: voxels along the longest side
  std::optional<double> voxelSize;              ///< [convert] voxel_size: world units
  std::optional<std::array<double, 6>> bounds;  ///< [convert] bounds: as in ConvertOptions
  std::optional<std::vector<GridKind>> grids;
  std::optional<PartBy> partBy;                       ///< [convert] part_by
  std::optional<Split> split;                         ///< [convert] split
  std::optional<double> weldTolerance;                ///< [convert] weld: world units
  std::optional<ComponentLimit> dropComponents = {};  ///< [convert] drop_components
  std::optional<bool> strict;                         ///< [convert] strict: no repair
  VolumeOptions volume;                      ///< [convert] fill and the other options of volumes
  std::optional<StopRule> until;             ///< [convert] until: default for objects
  std::optional<Voxelize> voxelize;          ///< [convert] voxelize: default for objects
  std::vector<SceneObject> objects;          ///< at least one
  std::vector<std::filesystem::path> files;  ///< the input file, then its meshes
  std::string inputHash;                     ///< of the contents of `files`; empty without files
};

/// Reads a scene file (.toml, DESIGN section 15), or a mesh file as a scene of one object.
///
/// Paths in a scene are relative to its folder. A transform scales, then rotates about x, y and z
/// (degrees, in this order, counter-clockwise seen from the tip of the axis), then translates. If
/// it mirrors, the faces are turned round, so that their outside stays outside. At last all objects
/// are scaled about the origin of the world.
///
/// @param scale  wins over the key `scale` of the scene; default 1
/// @throws InputError  the file is unreadable or malformed; for an unknown key or a wrong type the
///   message starts with "FILE:LINE:COLUMN: "
/// @throws UsageError  the parameter `scale` is not positive and finite
Scene readScene(const std::filesystem::path& file, std::optional<double> scale = {});

/// Reads a scene from the content of a scene file.
/// @param file  gives the folder of paths in the scene, and is named in messages
/// @throws InputError, UsageError  as readScene
Scene parseScene(const std::filesystem::path& file, std::string_view content,
                 std::optional<double> scale = {});

}  // namespace vox
