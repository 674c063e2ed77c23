// Selects the vertices through which the surface passes: boundary vertices for boundary
// interpolation, interior vertices for lifting.

#include "libvox/prepare/interpolate.h"

#include "libvox/mesh/vertex_kind.h"
#include "libvox/prepare/boundary.h"

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

}  // namespace

PolygonMesh interpolate(PolygonMesh mesh, const Adjacency& adjacency, Interpolate which,
                        std::span<const Index> prescribed, InterpolationReport& report) {
  report = {};
  const bool interior = which == Interpolate::kInterior || which == Interpolate::kBoth;
  const bool boundary = which == Interpolate::kBoundary || which == Interpolate::kBoth;
  const std::vector<VertexKind> kinds = vertexKinds(mesh, adjacency);
  if (boundary) {
    report.boundaryVertices =
        static_cast<Index>(std::count(kinds.begin(), kinds.end(), VertexKind::kBoundary));
    mesh = interpolateBoundary(std::move(mesh), adjacency);
  }
  const std::vector<Index> vertices = verticesToLift(mesh, kinds, interior, boundary, prescribed);
  if (vertices.empty()) return mesh;
  return lift(std::move(mesh), adjacency, vertices, report.lift);
}

}  // namespace vox
