#pragma once

#include "libvox/grid/openvdb.h"
#include "libvox/inspect/diff.h"
#include "libvox/inspect/difference_grids.h"
#include "libvox/render/visible.h"

#include <optional>

namespace vox {

/// How a voxel of two grids differs.
enum class VoxelChange { kUnchanged, kOnlyA, kOnlyB, kValue };

/// The voxels of two grids, coloured by what differs. Of level sets only voxels within one voxel of
/// the surface are shown: their bands hide each other. If no such voxel differs, all are shown.
class DifferenceLook {
 public:
  /// @throws InputError  a type that cannot be compared
  DifferenceLook(const openvdb::GridBase& a, const openvdb::GridBase& b,
                 const DiffOptions& options);

  const openvdb::MaskTree& all() const { return *all_; }
  const openvdb::MaskTree& differing() const { return *differing_; }
  /// |a - b| where both are active and differ; null if there are no values.
  const openvdb::FloatTree* values() const;
  /// The largest finite difference of values.
  double largest() const { return largest_; }

  VoxelChange changeAt(const openvdb::Coord& voxel) const;
  /// Difference of the values at a voxel relative to the largest, 0 .. 1.
  double valuePart(const openvdb::Coord& voxel) const;

  /// True if no values differ, and the same voxels are active in one grid only.
  bool looksLike(const DifferenceLook& other) const;

  /// True if voxels that differ are not shown: those of a level set that are far from its surface.
  bool isPartial() const { return isPartial_; }

  /// For pictures: the voxels in their colours. They need this object as long as they are used.
  /// @param box  those within it only; empty: all
  VisibleGrids visibleAll(const openvdb::CoordBBox& box) const { return visible(all_, box); }
  VisibleGrids visibleDiffering(const openvdb::CoordBBox& box) const {
    return visible(differing_, box);
  }

 private:
  VisibleGrids visible(const openvdb::MaskTree::Ptr& voxels, const openvdb::CoordBBox& box) const;
  std::optional<openvdb::Vec3f> colorAt(const openvdb::Coord& voxel) const;

  DifferenceGrids difference_;
  openvdb::MaskTree::Ptr all_;
  openvdb::MaskTree::Ptr differing_;
  bool isPartial_ = false;
  double largest_ = 0;
};

}  // namespace vox
