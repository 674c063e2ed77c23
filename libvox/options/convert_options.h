#pragma once

#include "libvox/options/grid_kind.h"
#include "libvox/options/part_options.h"
#include "libvox/options/preparation_options.h"
#include "libvox/options/run_options.h"
#include "libvox/options/run_part.h"
#include "libvox/options/stop_rule.h"
#include "libvox/options/surface_options.h"
#include "libvox/options/texture_spec.h"
#include "libvox/options/volume_options.h"
#include "libvox/options/voxelize.h"

#include <array>
#include <optional>
#include <vector>

namespace vox {

inline constexpr int kDefaultDim = 256;

/// How to convert. A value that is not set comes from the object, else from the scene, else from
/// the default.
struct ConvertOptions : PreparationOptions {
  /// Of the input; readScene has applied it. Grids record it, so that it can be applied again.
  std::optional<double> scale;
  std::optional<int> dim;  ///< voxels along the longest side of the input; default: kDefaultDim
  std::optional<double> voxelSize;  ///< world units; overrides dim
  /// World position of the centre of voxel (0, 0, 0) in the output, which a turn does not change.
  /// Needs voxelSize. Default: 0; for blender-3.4: half a voxel less.
  std::optional<std::array<double, 3>> origin;
  /// Corners of a box, world units of the input before a turn: only voxels whose centres lie in it
  /// are made. First the low corner.
  std::optional<std::array<double, 6>> bounds;
  /// The same by voxels: the lowest voxel, then the highest. Both apply.
  std::optional<std::array<int, 6>> clip;
  std::optional<RunPart> part;                 ///< default: all pages
  std::optional<std::vector<GridKind>> grids;  ///< default: density
  std::optional<PartBy> partBy;      ///< default: the first by which the input has several parts
  std::optional<Split> split;        ///< default: one grid of all densities
  std::optional<StopRule> until;     ///< default: voxel
  std::optional<Voxelize> voxelize;  ///< default: auto
  Separation separation = Separation::k6;
  VolumeOptions volume;
  /// Replaces the textures and colours of all objects, and adds the color grid to those of the
  /// scene.
  std::optional<TextureSpec> texture;
  SurfaceOptions surface;
  RunOptions run;
};

}  // namespace vox
