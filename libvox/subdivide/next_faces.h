#pragma once

#include "libvox/mesh/polygon_mesh.h"
#include "libvox/subdivide/level.h"

#include <vector>

namespace vox {

/// The faces of the next level, some at a time, for callers that need neither all of them at once
/// nor their adjacency. Const and thread-safe.
class NextFaces {
 public:
  /// @param level  must outlive this object
  explicit NextFaces(const SubdivisionLevel& level);

  /// Appends the faces of the next level that a corner leads: the F-face, if it is the first corner
  /// of its face; the E-face, if it leads its edge; the V-face, if it leads a one-ring; both half
  /// faces, if its edge is on the boundary of level 0 of an extended mesh. The faces led by all
  /// corners are those of nextLevel, each with the same points in the same order.
  /// @param faces  gets no points: those of its faces are imageVertices(level)
  void append(Index corner, PolygonMesh& faces) const;

 private:
  void appendHalfFaces(Index corner, PolygonMesh& faces) const;
  Index boundaryPoint(Index corner) const;

  const SubdivisionLevel& level_;
  std::vector<Index> boundary_;  // the corners of the boundary, if half faces are made there
};

}  // namespace vox
