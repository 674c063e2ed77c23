// Faces of the input are joined if faces that repair made of them share an edge.

#include "libvox/prepare/debris.h"

#include "libvox/core/forest.h"
#include "libvox/mesh/adjacency.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <span>
#include <vector>

namespace vox {
namespace {

/// The components of the input faces of a mesh.
Forest componentsOfInput(const PolygonMesh& mesh, const RepairOptions& options) {
  RepairReport report;
  PolygonMesh repaired = repair(mesh, options, report);
  for (Index& v : repaired.faceVertices) v = report.pointOrigin[v];  // copies are one vertex again
  const CornerFaces faces(repaired);
  const auto origin = [&](const EdgeCorner& corner) {
    return report.faceOrigin[faces[corner.corner]];
  };
  Forest components(mesh.faceCount());
  forEachEdge(cornersByEdge(repaired), [&](std::span<const EdgeCorner> edge) {
    for (const EdgeCorner& corner : edge) components.unite(origin(edge[0]), origin(corner));
  });
  return components;
}

struct DebrisCandidate {
  Index faces = 0;
  Eigen::AlignedBox3d box;

  double diagonal() const { return box.isEmpty() ? 0 : (box.max() - box.min()).stableNorm(); }
  bool isBelow(const ComponentLimit& limit) const {
    return faces < limit.below.value_or(0) || diagonal() < limit.size.value_or(0);
  }
};

}  // namespace

std::string summary(const DebrisReport& report) {
  if (report.dropped == 0) return {};
  return "dropped " + std::to_string(report.dropped) + " component" +
         (report.dropped == 1 ? "" : "s") + " of " + std::to_string(report.droppedFaces) + " face" +
         (report.droppedFaces == 1 ? "" : "s");
}

PolygonMesh withoutDebris(const PolygonMesh& mesh, const ComponentLimit& limit,
                          const RepairOptions& options, DebrisReport& report) {
  report = {};
  Forest components = componentsOfInput(mesh, options);
  std::vector<DebrisCandidate> candidates(mesh.faceCount());  // at the root of each component
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    DebrisCandidate& candidate = candidates[components.find(f)];
    ++candidate.faces;
    for (const Index v : mesh.face(f)) candidate.box.extend(mesh.points[v]);
  }
  for (const DebrisCandidate& candidate : candidates) {
    if (candidate.faces == 0) continue;
    ++report.components;
    report.mostFaces = std::max(report.mostFaces, candidate.faces);
    report.largestDiagonal = std::max(report.largestDiagonal, candidate.diagonal());
    if (!candidate.isBelow(limit)) continue;
    ++report.dropped;
    report.droppedFaces += candidate.faces;
  }
  if (report.dropped == 0) return mesh;
  PolygonMesh kept;
  kept.points = mesh.points;
  kept.pointColors = mesh.pointColors;
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    if (candidates[components.find(f)].isBelow(limit)) continue;
    kept.addFace(mesh.face(f));
    if (!mesh.faceColors.empty()) kept.faceColors.push_back(mesh.faceColors[f]);
    report.keptFaces.push_back(f);
  }
  return kept;
}

}  // namespace vox
