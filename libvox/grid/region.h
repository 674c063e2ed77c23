#pragma once

#include "libvox/grid/leaf_words.h"
#include "libvox/grid/openvdb_fwd.h"
#include "libvox/grid/transform.h"

#include <openvdb/math/Coord.h>

#include <optional>

namespace vox {

/// The voxels that a conversion makes: all, or those in a box.
class Region {
 public:
  Region() = default;  ///< all voxels
  /// @param box  both corners belong to it; may be empty
  explicit Region(const openvdb::CoordBBox& box) : box_(box) {}

  bool isAll() const { return !box_; }
  bool isEmpty() const { return box_ && box_->empty(); }
  /// Precondition: not all.
  const openvdb::CoordBBox& box() const { return *box_; }

  bool contains(const openvdb::Coord& voxel) const { return !box_ || box_->isInside(voxel); }
  /// Whether the cube of some voxel meets a box. @param part  index space
  bool meets(const Box& part) const;
  /// The voxels of a set that belong to the region. @param origin  of the leaf
  LeafWords within(const LeafWords& voxels, const openvdb::Coord& origin) const;

  /// The voxels that are in both.
  Region operator&(const Region& other) const;
  /// More voxels on all sides.
  Region grown(int voxels) const;

 private:
  std::optional<openvdb::CoordBBox> box_;
};

/// The voxels whose centres lie in a box, or so little outside that rounding may be the reason.
/// @param box  world units, before the turn of the transform
Region regionOf(const Box& box, const GridTransform& transform);

}  // namespace vox
