#pragma once

#include "libvox/core/types.h"
#include "libvox/mesh/mesh_attributes.h"

#include <cstdint>
#include <span>
#include <vector>

namespace vox {

/// Face-vertex mesh of arbitrary polygons in flat arrays (CSR).
///
/// A corner is one slot of faceVertices. Corner c also names the directed edge from its vertex to
/// the vertex of the next corner in its face. Faces may be concave, non-planar and of any size;
/// points may be shared, duplicated or unused.
struct PolygonMesh {
  std::vector<Vec3d> points;             ///< V positions (world units, or voxels once transformed)
  std::vector<Index> faceOffsets = {0};  ///< F + 1: face f has corners [offset f, offset f + 1)
  std::vector<Index> faceVertices;       ///< C: the point of each corner
  std::vector<Vec3f> pointColors;        ///< V linear colours, 0 to 1, or empty
  std::vector<Vec3f> faceColors;         ///< F linear colours, 0 to 1, or empty
  std::vector<std::uint32_t> faceGroups = {};  ///< F smoothing groups, 0: flat; or empty
  MeshAttributes attributes = {};              ///< of an input; prepared meshes have none

  Index faceCount() const { return static_cast<Index>(faceOffsets.size() - 1); }
  Index cornerCount() const { return static_cast<Index>(faceVertices.size()); }
  Index pointCount() const { return static_cast<Index>(points.size()); }

  /// Number of corners of face f.
  Index faceSize(Index f) const { return faceOffsets[f + 1] - faceOffsets[f]; }

  /// Points of face f in order.
  std::span<const Index> face(Index f) const {
    return {faceVertices.data() + faceOffsets[f], faceSize(f)};
  }

  /// Appends a face.
  void addFace(std::span<const Index> vertices) {
    faceVertices.insert(faceVertices.end(), vertices.begin(), vertices.end());
    faceOffsets.push_back(cornerCount());
  }
};

/// Appends `part` to `all`, without colours, groups and attributes.
/// Precondition: together they have fewer than 2^32 - 1 points, faces and corners.
inline void append(PolygonMesh& all, const PolygonMesh& part) {
  const Index firstPoint = all.pointCount();
  const Index firstCorner = all.cornerCount();
  all.points.insert(all.points.end(), part.points.begin(), part.points.end());
  for (const Index v : part.faceVertices) all.faceVertices.push_back(firstPoint + v);
  for (Index f = 0; f < part.faceCount(); ++f)
    all.faceOffsets.push_back(firstCorner + part.faceOffsets[f + 1]);
}

}  // namespace vox
