#pragma once

#include "libvox/grid/openvdb_fwd.h"
#include "libvox/grid/region.h"
#include "libvox/options/surface_options.h"
#include "libvox/pipeline/choose.h"
#include "libvox/pipeline/surface_look.h"
#include "libvox/subdivide/level.h"
#include "libvox/volume/texture.h"

#include <Eigen/Geometry>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace vox {

/// A solid texture, and the transform from world space to the space of the texture.
struct PlacedTexture {
  SolidTexture texture;
  Eigen::Affine3d fromWorld;
};

/// Feet are looked for this far beyond the voxels asked for. Soft values at the end of a box depend
/// on voxels beside them.
inline constexpr int kMarginOfFeet = 8;  // voxels

/// An object that is ready to voxelize, in index space.
struct PreparedSurface {
  std::string name;
  SubdivisionLevel base;
  ConversionWay way;
  SurfaceOptions options;  ///< how it is cut into submeshes
  std::optional<PlacedTexture> texture = {};
  SurfaceLook look = {};
  std::vector<std::int32_t> partOfFace = {};  ///< per face of `base`; or empty
  /// The voxels of this object alone; null if no grid needs the objects separately.
  std::shared_ptr<openvdb::MaskTree> voxels = {};
  Index inputCorners = 0;  ///< of the input, for the progress
  Region region = {};      ///< the feet of other voxels are not needed
  /// Which components have no inside, and why: for a message. Empty if all have one, or nothing
  /// asks for it.
  std::string noInside = {};
};

}  // namespace vox
