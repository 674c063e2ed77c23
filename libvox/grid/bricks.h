#pragma once

#include "libvox/grid/openvdb_fwd.h"

#include <openvdb/math/Coord.h>

#include <optional>

namespace vox {

/// A brick is a cube of 128^3 voxels, aligned: what a lower node of a tree holds. Its coordinates
/// are those of its lowest voxel divided by 128.
inline constexpr int kBrickLog2 = 7;
inline constexpr int kBrickSide = 1 << kBrickLog2;  ///< voxels

/// Whether a brick comes before another one in an OpenVDB file: first by the upper nodes (of 32^3
/// bricks), then within them, both by x, then y, then z.
bool isBefore(const openvdb::Coord& brick, const openvdb::Coord& other);

/// The bricks of a part: a range in that order.
struct BrickRange {
  std::optional<openvdb::Coord> begin;  ///< the first one; nothing: there is no end to this side
  std::optional<openvdb::Coord> end;    ///< the first one after the range

  bool contains(const openvdb::Coord& brick) const {
    return (!begin || !isBefore(brick, *begin)) && (!end || isBefore(brick, *end));
  }
  /// Whether some voxel of a box lies in the range. Of a box over many thousand bricks the answer
  /// is yes.
  bool meets(const openvdb::CoordBBox& box) const;
};

}  // namespace vox
