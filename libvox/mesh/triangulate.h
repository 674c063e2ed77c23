#pragma once

#include "libvox/core/types.h"
#include "libvox/mesh/flat_polygon.h"
#include "libvox/mesh/polygon_mesh.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace vox {

/// Count of failures of triangulate, summed over any number of calls.
struct TriangulationReport {
  std::uint64_t fanned = 0;  ///< polygons that became a fan in part: folded, or without area
};

/// Cuts a polygon in space into triangles. It may have any number of corners, be concave, and need
/// not be planar. Appends max(n - 2, 0) triangles of corner numbers 0..n-1, wound like the polygon;
/// each side of the polygon is a side of one triangle. Never fails: if a part of the polygon has no
/// ear, it becomes a fan, and the polygon is counted in the report.
///
/// Seen along the normal of the polygon (its area vector), the triangles cover a simple polygon
/// without overlap; each has an area, but for one triangle for each corner at the place of the one
/// before. Corners may lie on sides, and sides may touch (a hole that a double bridge connects with
/// the outline).
/// Quads are cut along a diagonal that lies inside; if both or none do, along the shorter one; if
/// these are equal, along 0-2. Other polygons: ear clipping, the best-shaped ear first (largest
/// smallest angle, then shortest diagonal).
///
/// @param corners  n positions, finite, any unit
///
/// Deterministic and thread-safe. Cost O(n log n) on polygons whose ears are small, O(n^2) at
/// worst; 5000 corners take some 10 ms. Source: paper section 7; the normal: Newell's; ears:
/// Meisters 1975.
void triangulate(std::span<const Vec3d> corners, std::vector<std::array<Index, 3>>& triangles,
                 TriangulationReport& report);

/// The ear clipping of triangulate, for a projection of the caller's: a weakly simple polygon of 3
/// corners or more that runs counter-clockwise there.
/// @return false if ears ran out, so that the rest became a fan
bool clipEars(std::span<const Vec3d> corners, std::span<const FlatPoint> flat,
              std::vector<std::array<Index, 3>>& triangles);

/// Cuts faces of meshes into triangles. Keeps work space and a report. One object per thread.
class FaceTriangulator {
 public:
  /// Appends the triangles of face f, as indices of points of the mesh.
  void add(const PolygonMesh& mesh, Index f, std::vector<std::array<Index, 3>>& triangles) {
    add(mesh.points, mesh.face(f), triangles);
  }
  /// Appends the triangles of a face, as indices of points.
  void add(std::span<const Vec3d> points, std::span<const Index> face,
           std::vector<std::array<Index, 3>>& triangles);
  const TriangulationReport& report() const { return report_; }

 private:
  std::vector<Vec3d> corners_;
  TriangulationReport report_;
};

}  // namespace vox
