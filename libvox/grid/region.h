#pragma once

#include "libvox/grid/leaf_words.h"
#include "libvox/grid/openvdb_fwd.h"
#include "libvox/grid/pages.h"
#include "libvox/grid/transform.h"

#include <openvdb/math/Coord.h>

#include <optional>

namespace vox {

/// The voxels that a conversion makes: all, or those in a box, in a range of pages, or in both.
class Region {
 public:
  Region() = default;  ///< all voxels
  /// @param box  both corners belong to it; may be empty
  explicit Region(const openvdb::CoordBBox& box) : box_(box) {}
  explicit Region(const PageRange& pages) : pages_(pages) {}

  bool isAll() const { return !box_ && !pages_; }
  bool isEmpty() const { return box_ && box_->empty(); }
  /// Outside this box there is no voxel of the region; nothing: there is no such box.
  const std::optional<openvdb::CoordBBox>& box() const { return box_; }
  /// Whether pages limit the region, too.
  bool hasPages() const { return pages_.has_value(); }

  bool contains(const openvdb::Coord& voxel) const {
    return (!box_ || box_->isInside(voxel)) && meetsPages(openvdb::CoordBBox(voxel, voxel));
  }
  /// Whether the cube of some voxel meets a box. @param part  index space
  bool meets(const Box& part) const;
  /// Whether the pages of the region, with its margin, hold a voxel of a box.
  bool meetsPages(openvdb::CoordBBox box) const {
    if (!pages_) return true;
    box.expand(margin_);
    return pages_->meets(box);
  }
  /// The voxels of a set that belong to the region. At the margin of pages whole leaves do.
  /// @param origin  of the leaf
  LeafWords within(const LeafWords& voxels, const openvdb::Coord& origin) const;

  /// The voxels that are in both. Precondition: at most one of them has pages.
  Region operator&(const Region& other) const;
  /// More voxels on all sides.
  Region grown(int voxels) const;

 private:
  std::optional<openvdb::CoordBBox> box_;
  std::optional<PageRange> pages_;
  int margin_ = 0;  // of the pages, voxels
};

/// The voxels whose centres lie in a box, or so little outside that rounding may be the reason.
/// @param box  world units, before the turn of the transform
Region regionOf(const Box& box, const GridTransform& transform);

}  // namespace vox
