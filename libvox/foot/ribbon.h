#pragma once

#include "libvox/foot/cell.h"

#include <vector>

namespace vox {

/// A point on the border of a piece.
struct RibbonPoint {
  double u, v;  ///< parameters of the piece
  Vec3d point;
  Vec3d normal;  ///< of the surface; 0 if it has none there
};

/// A piece that is much longer than wide and far narrower than a voxel, as a strip of triangles
/// between the two halves of its border: from one corner to the opposite one.
struct Ribbon {
  std::vector<RibbonPoint> right, left;  ///< as many; seen from outside and from the first point

  /// Sets the ribbon of a piece.
  /// @param crease  the piece is at a crease; at its corners, normals are those a little farther in
  /// @return whether the piece is narrow enough
  bool set(const LimitPiece& piece, bool crease);
};

/// Adds the triangles of a ribbon to a store, as cells of the kind kRibbon.
/// @param reach  largest distance of interest, voxels
/// @param creaseBias  of the cells
void addRibbon(const Ribbon& ribbon, const LimitPiece& piece, float reach, float creaseBias,
               std::uint32_t owner, CellStore& store);

}  // namespace vox
