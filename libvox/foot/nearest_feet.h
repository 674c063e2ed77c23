#pragma once

#include "libvox/foot/foot_bins.h"
#include "libvox/grid/leaf_words.h"
#include "libvox/grid/openvdb_fwd.h"

#include <array>
#include <bit>
#include <cstdint>
#include <functional>

namespace vox {

class Progress;

/// The place of a foot: a cell, and its parameters there.
struct FootPlace {
  const BinnedCell* cell;
  float a, b;
};

/// The nearest feet of some voxels of a leaf.
struct LeafFeet {
  LeafWords found;                   ///< voxels with a foot
  std::array<float, 512> distance;   ///< voxels; negative on the inner side
  std::array<FootPlace, 512> place;  ///< in OpenVDB's order of voxels

  /// Calls visit(number of the voxel in the leaf) for each voxel with a foot.
  template <class Visit>
  void forEachFound(Visit&& visit) const {
    for (unsigned x = 0; x < 8; ++x)
      for (std::uint64_t left = found[x]; left != 0; left &= left - 1)
        visit(x << 6 | static_cast<unsigned>(std::countr_zero(left)));
  }
};

/// The outward normal at a foot, of any length; 0 where there is none. Of a polygon mesh: that of
/// the face, or at its edges and vertices the mean of the faces'.
Float3 normalAt(const FootBins& bins, const FootPlace& at);

/// A place in the square of a corner (mesh/limit_piece.h).
struct SurfacePlace {
  double u, v;
};
/// The place of a foot on the limit surface, in the square of the corner that owns the cell.
/// Precondition: the cell is no kTriangle.
SurfacePlace placeAt(const FootBins& bins, const FootPlace& at);

/// Calls visit(origin of the leaf, feet) for each leaf with voxels that have a foot within the
/// reach of the cells; from any thread, once per leaf. Of equally near feet it is the one in the
/// first cell of the bin, so the same for any number of threads.
/// @param bins    without polynomial cells
/// @param voxels  without tiles
/// @param part    the share of this in the current stage of `progress`
/// @throws Cancelled
void forEachFoot(const FootBins& bins, const openvdb::MaskTree& voxels, Progress& progress,
                 double part,
                 const std::function<void(const openvdb::Coord&, const LeafFeet&)>& visit);

}  // namespace vox
