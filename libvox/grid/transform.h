#pragma once

#include "libvox/core/types.h"
#include "libvox/mesh/polygon_mesh.h"
#include "libvox/options/volume_options.h"

#include <limits>
#include <optional>
#include <span>
#include <string>

namespace vox {

/// Axis-aligned box in world units; at first empty.
struct Box {
  Vec3d low = Vec3d::Constant(std::numeric_limits<double>::infinity());
  Vec3d high = Vec3d::Constant(-std::numeric_limits<double>::infinity());

  bool empty() const { return !(low.array() <= high.array()).all(); }
  /// Whether two boxes have a point in common.
  bool meets(const Box& other) const {
    return (low.array() <= other.high.array()).all() && (other.low.array() <= high.array()).all();
  }
  double longestSide() const { return empty() ? 0 : (high - low).maxCoeff(); }
  void add(const Vec3d& p) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  void add(const Box& part) {
    low = low.cwiseMin(part.low);
    high = high.cwiseMax(part.high);
  }
};

/// Box of all points that belong to a face.
Box usedBox(const PolygonMesh& mesh);
/// Box of the points of some faces.
Box boxOf(const PolygonMesh& mesh, std::span<const Index> faces);

/// Quarter turn about the x axis, from world space to the axes of the grid.
enum class Turn {
  kNoTurn,
  kYToZ,  ///< the y axis becomes the z axis
  kZToY,
};

inline Vec3d turned(const Vec3d& p, Turn turn) {
  if (turn == Turn::kYToZ) return {p.x(), -p.z(), p.y()};
  if (turn == Turn::kZToY) return {p.x(), p.z(), -p.y()};
  return p;
}

/// The opposite turn.
inline Turn inverse(Turn turn) {
  if (turn == Turn::kNoTurn) return turn;
  return turn == Turn::kYToZ ? Turn::kZToY : Turn::kYToZ;
}

/// The turn that makes the axis `up` of the input the axis that points up in the target: z in
/// Blender, y in Houdini. No turn if `up` is empty.
Turn turnFor(std::optional<UpAxis> up, Target target);

/// Transform between world space and index space: index = (turned(world) - origin) / voxelSize.
/// Voxel (i, j, k) is the unit cube centred on (i, j, k) in index space. Unless another file gives
/// the lattice, the origin is 0, so voxels of grids with the same voxel size coincide.
struct GridTransform {
  double voxelSize = 1;  ///< world units, > 0
  Turn turn = Turn::kNoTurn;
  Vec3d origin = Vec3d::Zero();  ///< centre of voxel (0, 0, 0) after the turn, world units

  Vec3d toIndex(const Vec3d& world) const { return (turned(world, turn) - origin) / voxelSize; }
  Vec3d toWorld(const Vec3d& index) const {
    return turned(index * voxelSize + origin, inverse(turn));
  }
};

/// Bound of absolute index coordinates: half of OpenVDB's 32-bit range, so that neighbours and
/// filters never overflow. A double still resolves 2.4e-7 voxels there.
inline constexpr double kMaxIndex = 1 << 30;

/// Range of voxel sizes. OpenVDB refuses a transform whose determinant is below 3e-15.
inline constexpr double kMinVoxelSize = 1.5e-5;
inline constexpr double kMaxVoxelSize = 1e18;

/// Transform with `dim` voxels along the longest side of the box.
/// @throws UsageError  dim < 1
/// @throws InputError  the box has no extent: all points are equal
/// @throws LimitError  the voxel size is out of range
GridTransform transformForDim(const Box& box, int dim);

/// Transform with this voxel size, in world units, without a turn.
/// @throws UsageError  voxelSize is not a positive finite number
/// @throws LimitError  voxelSize is out of range
GridTransform transformForVoxelSize(double voxelSize);

/// Checks that the index coordinates of a box are below kMaxIndex.
/// @param what  subject of the message
/// @throws LimitError  they are not; the message names the smallest voxel size that works, unless
///   the lattice has an origin
void requireInRange(const Box& boxWorld, const GridTransform& transform,
                    const std::string& what = "the input");

}  // namespace vox
