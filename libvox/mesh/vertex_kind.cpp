// Walks around each vertex and compares the corners met with all corners of the vertex.

#include "libvox/mesh/vertex_kind.h"

#include "libvox/core/parallel.h"

namespace vox {
namespace {

constexpr Index kKindsPerTask = 4096;
constexpr Index kFewestForFace = 3;

VertexKind kindOf(const PolygonMesh& mesh, const Adjacency& adjacency, Index corner, Index count) {
  Index walked = 1;
  Index c = nextAroundVertex(mesh, adjacency, corner);
  for (; c != kNone && c != corner; c = nextAroundVertex(mesh, adjacency, c)) ++walked;
  const bool closed = c == corner;
  if (!closed)
    for (c = previousAroundVertex(mesh, adjacency, corner); c != kNone;
         c = previousAroundVertex(mesh, adjacency, c))
      ++walked;
  if (walked != count) return VertexKind::kBowTie;
  if (!closed) return VertexKind::kBoundary;
  return count < kFewestForFace ? VertexKind::kTwoFaces : VertexKind::kInterior;
}

}  // namespace

std::vector<VertexKind> vertexKinds(const PolygonMesh& mesh, const Adjacency& adjacency) {
  std::vector<Index> corner(mesh.pointCount(), kNone);
  std::vector<Index> count(mesh.pointCount(), 0);
  for (Index c = 0; c < mesh.cornerCount(); ++c) {
    corner[mesh.faceVertices[c]] = c;
    ++count[mesh.faceVertices[c]];
  }
  std::vector<VertexKind> kinds(mesh.pointCount(), VertexKind::kUnused);
  parallelForEach(mesh.pointCount(), kKindsPerTask, [&](Index v) {
    if (corner[v] != kNone) kinds[v] = kindOf(mesh, adjacency, corner[v], count[v]);
  });
  return kinds;
}

}  // namespace vox
