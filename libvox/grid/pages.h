#pragma once

#include "libvox/grid/openvdb_fwd.h"

#include <openvdb/math/Coord.h>

#include <cstddef>
#include <optional>

namespace vox {

/// A page is a cube of 128^3 voxels, aligned: what a lower node of a tree holds. Its coordinates
/// are those of its lowest voxel divided by 128.
inline constexpr int kPageLog2 = 7;
inline constexpr int kPageSide = 1 << kPageLog2;  ///< voxels

/// Whether a page comes before another one in an OpenVDB file: first by the upper nodes (of 32^3
/// pages), then within them, both by x, then y, then z.
bool isBefore(const openvdb::Coord& page, const openvdb::Coord& other);

/// The pages of a part: a range in that order.
struct PageRange {
  std::optional<openvdb::Coord> begin;  ///< the first one; nothing: there is no end to this side
  std::optional<openvdb::Coord> end;    ///< the first one after the range

  bool contains(const openvdb::Coord& page) const {
    return (!begin || !isBefore(page, *begin)) && (!end || isBefore(page, *end));
  }
  /// Whether some voxel of a box lies in the range. Of a box over many thousand pages the answer
  /// is yes.
  bool meets(const openvdb::CoordBBox& box) const;
};

/// The pages of one of several runs.
struct PageShare {
  PageRange range;
  std::size_t pages = 0;  ///< that surfaces meet
  double cost = 0;        ///< part of the cost of all
};

}  // namespace vox
