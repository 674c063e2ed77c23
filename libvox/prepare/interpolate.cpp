// Selects the vertices through which the surface passes: boundary vertices for boundary
// interpolation, interior vertices for lifting.

#include "libvox/prepare/interpolate.h"

#include "libvox/mesh/vertex_kind.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace vox {
namespace {

/// The vertices to lift: the prescribed ones, except those that boundary interpolation already
/// moves, and with `interior` all interior ones.
std::vector<Index> verticesToLift(const PolygonMesh& mesh, const std::vector<VertexKind>& kinds,
                                  bool interior, bool boundary, std::span<const Index> prescribed) {
  std::vector<Index> vertices;
  for (const Index v : prescribed) {
    const bool served = boundary && v < mesh.pointCount() && kinds[v] == VertexKind::kBoundary;
    if (!served) vertices.push_back(v);
  }
  for (Index v = 0; interior && v < mesh.pointCount(); ++v)
    if (kinds[v] == VertexKind::kInterior) vertices.push_back(v);
  return vertices;
}

/// The vertices that are no corners of creases.
std::vector<Index> withoutCorners(const PolygonMesh& mesh, const CreaseCut& cut,
                                  std::span<const Index> vertices) {
  std::vector<Index> others(vertices.begin(), vertices.end());
  if (cut.seam.empty()) return others;
  std::vector<bool> isCorner(mesh.pointCount(), false);
  for (Index f = 0; f < mesh.faceCount(); ++f)
    for (Index c = mesh.faceOffsets[f]; c < mesh.faceOffsets[f + 1]; ++c) {
      if (cut.seam[c] != c) continue;  // not an edge without length
      const Index next = c + 1 == mesh.faceOffsets[f + 1] ? mesh.faceOffsets[f] : c + 1;
      isCorner[mesh.faceVertices[c]] = isCorner[mesh.faceVertices[next]] = true;
    }
  std::erase_if(others, [&](Index v) { return v < isCorner.size() && isCorner[v]; });
  return others;
}

}  // namespace

PolygonMesh interpolate(PolygonMesh mesh, const Adjacency& adjacency, Interpolate which,
                        std::span<const Index> prescribed, InterpolationReport& report,
                        const CreaseCut& cut) {
  report = {};
  const bool interior = which == Interpolate::kInterior || which == Interpolate::kBoth;
  const bool boundary = which == Interpolate::kBoundary || which == Interpolate::kBoth;
  const std::vector<VertexKind> kinds = vertexKinds(mesh, adjacency);
  if (boundary) {
    report.boundaryVertices =
        static_cast<Index>(std::count(kinds.begin(), kinds.end(), VertexKind::kBoundary));
    mesh = interpolateBoundary(std::move(mesh), adjacency, cut);
  }
  const std::vector<Index> vertices =
      verticesToLift(mesh, kinds, interior, boundary, withoutCorners(mesh, cut, prescribed));
  if (vertices.empty()) return mesh;
  return lift(std::move(mesh), adjacency, vertices, report.lift);
}

}  // namespace vox
