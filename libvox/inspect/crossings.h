#pragma once

#include "libvox/core/types.h"
#include "libvox/grid/openvdb.h"

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vox {

struct ReferenceSurface;

/// Points on the lattice of 2^-16 voxels: neighbouring triangles leave no gap.
using LatticePoint = std::array<std::int64_t, 3>;
inline constexpr std::int64_t kLattice = 65536;

using LatticeEdge = std::array<LatticePoint, 2>;
using LatticeTriangle = std::array<LatticePoint, 3>;

/// The triangles of a surface; triangles at the same place only once.
std::vector<LatticeTriangle> onLattice(const ReferenceSurface& surface);

/// Sides that do not belong to exactly two triangles.
std::vector<LatticeEdge> boundaryOf(std::span<const LatticeTriangle> triangles);

/// Steps along one axis that cross the surface an odd number of times, by their lower voxel.
class Crossings {
 public:
  explicit Crossings(std::size_t axis) : axis_(axis), accessor_(odd_) {}

  const openvdb::MaskTree& odd() const { return odd_; }

  /// Adds the places where columns of voxel centres pierce a triangle. A column that meets a side
  /// or corner counts for one of the triangles there, as in a point-in-polygon test with half-open
  /// sides.
  void add(const LatticeTriangle& triangle);

 private:
  void toggle(const LatticeTriangle& triangle, std::size_t u, std::size_t v, std::int64_t atU,
              std::int64_t atV);

  std::size_t axis_;
  openvdb::MaskTree odd_;
  openvdb::tree::ValueAccessor<openvdb::MaskTree> accessor_;
};

}  // namespace vox
