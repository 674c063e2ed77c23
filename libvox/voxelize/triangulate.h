#pragma once

#include "libvox/core/types.h"
#include "libvox/mesh/polygon_mesh.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace vox {

/// Polygons that no ears were found for, over any number of calls.
struct TriangulationReport {
  std::uint64_t fanned = 0;  ///< polygons whose rest, folded or without area, became a fan
};

/// Cuts a polygon in space into triangles: any number of corners, concave, not planar. Appends
/// max(n - 2, 0) triangles of corner numbers 0..n-1, wound as the polygon; each side of the polygon
/// is a side of one triangle. Never fails: what has no ear becomes a fan and is counted.
///
/// Seen along the polygon's normal (its area vector), the triangles cover a simple polygon without
/// overlap, and none is without area unless repeated corners force it. Corners may lie on sides and
/// sides may touch (a hole joined to the outside by a bridge there and back).
/// Quads: along the shorter diagonal of the two, or of those that lie inside; equal ones: 0-2.
/// Others: ear clipping, the best-shaped ear first (smallest angle, then short diagonal).
///
/// @param corners  n positions, finite, any unit
///
/// Deterministic and thread-safe. Cost O(n log n) on polygons whose ears are small, O(n^2) at
/// worst; 5000 corners take some 10 ms. Source: paper section 7; the normal: Newell's; ears:
/// Meisters 1975.
void triangulate(std::span<const Vec3d> corners, std::vector<std::array<Index, 3>>& triangles,
                 TriangulationReport& report);

/// Cuts faces of meshes into triangles; keeps its work space and its report.
class FaceTriangulator {
 public:
  /// Appends the triangles of face f, given by points of the mesh.
  void add(const PolygonMesh& mesh, Index f, std::vector<std::array<Index, 3>>& triangles);
  const TriangulationReport& report() const { return report_; }

 private:
  std::vector<Vec3d> corners_;
  TriangulationReport report_;
};

}  // namespace vox
