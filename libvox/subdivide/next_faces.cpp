// Faces of the next level by walks over the corners of this one: their order of points is that of
// ChildTopology in doo_sabin.cpp.

#include "libvox/subdivide/next_faces.h"

#include "libvox/subdivide/doo_sabin.h"
#include "libvox/subdivide/strip.h"

#include <algorithm>
#include <array>

namespace vox {

NextFaces::NextFaces(const SubdivisionLevel& level) : level_(level) {
  if (level.boundary == BoundaryStage::kExtend) boundary_ = boundaryCorners(level.adjacency);
}

void NextFaces::append(Index corner, PolygonMesh& faces) const {
  const PolygonMesh& mesh = level_.mesh;
  const Adjacency& adjacency = level_.adjacency;
  const auto add = [&](Index point) { faces.faceVertices.push_back(point); };
  const auto finish = [&] { faces.faceOffsets.push_back(faces.cornerCount()); };

  const Index face = adjacency.cornerFace[corner];
  if (corner == mesh.faceOffsets[face]) {
    for (Index c = corner; c != mesh.faceOffsets[face + 1]; ++c) add(c);
    finish();
  }
  const Index twin = adjacency.twin[corner];
  if (leadsEdge(adjacency, corner))
    faces.addFace(std::array{nextCorner(mesh, adjacency, corner), corner,
                             nextCorner(mesh, adjacency, twin), twin});
  if (twin == kNone && !boundary_.empty()) return appendHalfFaces(corner, faces);
  const Index valence = ledOneRingSize(mesh, adjacency, corner);
  if (valence < 3) return;
  Index c = corner;
  for (Index i = 0; i < valence; ++i, c = nextAroundVertex(mesh, adjacency, c)) add(c);
  finish();
}

void NextFaces::appendHalfFaces(Index corner, PolygonMesh& faces) const {
  const PolygonMesh& mesh = level_.mesh;
  const Adjacency& adjacency = level_.adjacency;
  Index last = corner;
  for (Index c = corner; c != kNone; c = nextAroundVertex(mesh, adjacency, c)) {
    faces.faceVertices.push_back(c);
    last = c;
  }
  const Index point = boundaryPoint(corner);
  faces.faceVertices.push_back(boundaryPoint(previousCorner(mesh, adjacency, last)) + 1);
  faces.faceVertices.push_back(point);
  faces.faceOffsets.push_back(faces.cornerCount());
  faces.addFace(std::array{nextCorner(mesh, adjacency, corner), corner, point, point + 1});
}

/// The first of the two Chaikin points of a boundary edge.
Index NextFaces::boundaryPoint(Index corner) const {
  const auto at = std::lower_bound(boundary_.begin(), boundary_.end(), corner);
  return level_.mesh.cornerCount() + 2 * static_cast<Index>(at - boundary_.begin());
}

}  // namespace vox
