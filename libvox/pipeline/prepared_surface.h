#pragma once

#include "libvox/grid/openvdb_fwd.h"
#include "libvox/options/surface_options.h"
#include "libvox/pipeline/choose.h"
#include "libvox/subdivide/level.h"
#include "libvox/volume/texture.h"

#include <Eigen/Geometry>

#include <memory>
#include <optional>
#include <string>

namespace vox {

/// A solid texture, and the transform from world space to the space of the texture.
struct PlacedTexture {
  SolidTexture texture;
  Eigen::Affine3d fromWorld;
};

/// An object that is ready to voxelize, in index space.
struct PreparedSurface {
  std::string name;
  SubdivisionLevel base;
  ConversionWay way;
  SurfaceOptions options;  ///< how it is cut into submeshes
  std::optional<PlacedTexture> texture = {};
  /// The voxels of this object alone; null if no grid needs the objects separately.
  std::shared_ptr<openvdb::MaskTree> voxels = {};
  /// Which components have no inside, and why: for a message. Empty if all have one, or nothing
  /// asks for it.
  std::string noInside = {};
};

}  // namespace vox
