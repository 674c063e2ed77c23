#pragma once

#include "libvox/foot/nearest_feet.h"
#include "libvox/pipeline/prepared_surface.h"

#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace vox {

class MemoryBudget;
class Progress;

/// The surfaces from which feet come: limit surfaces, or the polygons of objects that are not
/// smoothed. Cells have owners (foot/cell.h).
struct FootSurfaces {
  std::span<const PreparedSurface> surfaces;
  /// Of each surface: its triangles if it is not smoothed, with the corners of the base mesh in the
  /// order of the triangles' corners.
  struct Flat {
    PolygonMesh triangles;
    std::vector<Index> corners;
  };
  std::vector<Flat> flat;
  std::vector<std::uint32_t> firstOwners;  ///< of the cells of each surface

  /// What a cell of the bins of these surfaces lies on.
  struct Owner {
    std::size_t surface;
    Index corner;           ///< of the base mesh, whose square has the cell
    const Index* triangle;  ///< three corners of a face, the first as above; null: limit surface
  };
  Owner ownerOf(const BinnedCell& cell) const;
};

/// How far feet are first looked for, in voxels. A voxel that a surface crosses is nearer than
/// sqrt(3) / 2; a vertex that switched it on may lie a little off the limit surface.
inline constexpr float kReachOfCrossed = 1.25F;
/// Of voxels around these.
inline constexpr float kReachOfSoft = 2.7F;

/// Calls visit(bins, origin of a leaf, feet) until every voxel had a foot, if it has one at all:
/// first near the surface, then, for voxels that are left over, farther and farther away. From any
/// thread; twice for a leaf only if other voxels have a foot.
/// @param voxels  without tiles
/// @param reach   how far feet are first looked for
/// @param part    the share of this in the current stage of `progress`
/// @throws LimitError
/// @throws Cancelled
using VisitFeet = std::function<void(const FootBins&, const openvdb::Coord&, const LeafFeet&)>;
void visitFeet(const FootSurfaces& surfaces, const openvdb::MaskTree& voxels, float reach,
               const MemoryBudget& budget, Progress& progress, double part, const VisitFeet& visit);

/// The bins that hold some voxels, ascending.
std::vector<openvdb::Coord> binsOf(const openvdb::MaskTree& voxels);

/// Collects the surfaces of feet.
FootSurfaces footSurfaces(std::span<const PreparedSurface> surfaces);

}  // namespace vox
