#pragma once

#include "libvox/grid/openvdb.h"
#include "libvox/render/visible_options.h"

#include <functional>
#include <optional>
#include <span>
#include <vector>

namespace vox {

/// The visible part of the grids of a file.
struct VisibleGrids {
  openvdb::MaskTree::ConstPtr voxels;     ///< solid voxels; null if there is a level set
  openvdb::FloatGrid::ConstPtr levelSet;  ///< null if there are voxels
  openvdb::Vec3SGrid::ConstPtr normals;   ///< world space; null if there are none
  openvdb::Vec3SGrid::ConstPtr colors;    ///< linear, 0 .. 1; null if there are none
  /// Colour of a voxel, instead of `colors`: linear; empty for plain ones. Called from any thread.
  std::function<std::optional<openvdb::Vec3f>(const openvdb::Coord&)> colorAt;
  openvdb::math::Transform::ConstPtr toWorld;  ///< of the grid that is shown; linear
  std::vector<openvdb::CoordBBox> boxes;  ///< of the voxels that are shown, or near the surface
};

/// Boxes of the active voxels of each leaf, and of active tiles.
std::vector<openvdb::CoordBBox> boxesOf(const openvdb::MaskTree& voxels);

/// Chooses what to show: the grid of the given name, or else the first that has voxels of `mask`,
/// `density`, `surface` and then any other of numbers. A level set shows its zero isosurface; of
/// anything else, active voxels above the threshold are solid. Normals are those of `normal` or
/// `N`, colours those of `color` or `Cd`, or else a colour for each number of `part`, if their
/// transform is that of what is shown.
///
/// @throws InputError  nothing can be shown: the message says why
/// @throws LimitError  voxels are further than 2^30 from the origin
VisibleGrids visibleGrids(std::span<const openvdb::GridBase::Ptr> grids,
                          const VisibleOptions& options);

}  // namespace vox
