// Counts and properties of meshes and grid files.

#include "libvox/inspect/summary.h"

#include "libvox/core/forest.h"
#include "libvox/grid/openvdb.h"
#include "libvox/io/read_vdb.h"
#include "libvox/mesh/adjacency.h"
#include "libvox/mesh/winding_forest.h"

#include <algorithm>
#include <span>

namespace vox {
namespace {

using Edge = std::span<const EdgeCorner>;

/// Components and orientability. An edge of three faces or more connects them, but does not relate
/// their windings.
void findComponents(const PolygonMesh& mesh, const Adjacency& adjacency,
                    const std::vector<EdgeCorner>& edges, MeshSummary& summary) {
  WindingForest faces(mesh.faceCount());
  const auto faceOf = [&](const EdgeCorner& corner) { return adjacency.cornerFace[corner.corner]; };
  forEachEdge(edges, [&](Edge edge) {
    if (edge.size() != 2 || edge[0].low == edge[0].high) return;
    const bool against = mesh.faceVertices[edge[0].corner] == mesh.faceVertices[edge[1].corner];
    if (faces.contradicts(faceOf(edge[0]), faceOf(edge[1]), against)) summary.orientable = false;
    faces.unite(faceOf(edge[0]), faceOf(edge[1]), against);
  });
  forEachEdge(edges, [&](Edge edge) {
    for (const EdgeCorner& corner : edge) faces.unite(faceOf(corner), faceOf(edge[0]), false);
  });
  for (Index f = 0; f < mesh.faceCount(); ++f) summary.components += faces.find(f).root == f;
}

void countValences(const PolygonMesh& mesh, const std::vector<EdgeCorner>& edges,
                   MeshSummary& summary) {
  std::vector<std::uint64_t> valence(mesh.pointCount(), 0);
  forEachEdge(edges, [&](Edge edge) {
    ++summary.edges;
    ++valence[edge[0].low];
    ++valence[edge[0].high];
  });
  for (const auto count : valence)
    if (count > 0) ++summary.valences[count];
}

void measureBoundary(const PolygonMesh& mesh, const std::vector<EdgeCorner>& edges,
                     MeshSummary& summary) {
  Forest loops(mesh.pointCount());
  const auto isBoundary = [](Edge edge) { return edge.size() == 1 && edge[0].low != edge[0].high; };
  forEachEdge(edges, [&](Edge edge) {
    if (isBoundary(edge)) loops.unite(edge[0].low, edge[0].high);
  });
  std::vector<Index> loopOf(mesh.pointCount(), kNone);  // by root
  forEachEdge(edges, [&](Edge edge) {
    if (!isBoundary(edge)) return;
    Index& loop = loopOf[loops.find(edge[0].low)];
    if (loop == kNone) {
      loop = static_cast<Index>(summary.boundaryLoops.size());
      summary.boundaryLoops.push_back(0);
    }
    ++summary.boundaryLoops[loop];
  });
  summary.closed = summary.boundaryLoops.empty();
}

/// The genus, from the rest of the summary.
void findGenus(MeshSummary& summary) {
  const bool manifold =
      std::all_of(summary.defects.begin(), summary.defects.end(), [](const Defect& defect) {
        return defect.kind == DefectKind::kInconsistentWinding ||
               defect.kind == DefectKind::kUnusedVertex;
      });
  if (summary.closed && summary.orientable && manifold)
    summary.genus =
        (2 * static_cast<std::int64_t>(summary.components) - summary.eulerCharacteristic) / 2;
}

GridSummary summarizeGrid(const openvdb::GridBase& grid) {
  GridSummary summary;
  summary.name = grid.getName();
  summary.type = grid.type();
  summary.gridClass = openvdb::GridBase::gridClassToString(grid.getGridClass());
  summary.activeVoxels = grid.activeVoxelCount();
  summary.leaves = grid.baseTree().leafCount();
  summary.memoryBytes = grid.memUsage();
  const openvdb::CoordBBox box = grid.evalActiveVoxelBoundingBox();
  const openvdb::Vec3d size = grid.voxelSize();
  const openvdb::Vec3d origin = grid.indexToWorld(openvdb::Coord(0, 0, 0));
  for (int axis = 0; axis < 3; ++axis) {
    const auto slot = static_cast<std::size_t>(axis);
    summary.low[slot] = box.min()[axis];
    summary.high[slot] = box.max()[axis];
    summary.voxelSize[slot] = size[axis];
    summary.origin[slot] = origin[axis];
  }
  for (auto entry = grid.beginMeta(); entry != grid.endMeta(); ++entry)
    summary.metadata[entry->first] = entry->second->str();
  return summary;
}

}  // namespace

MeshSummary summarize(const PolygonMesh& mesh) {
  requireValidArrays(mesh);
  const Adjacency adjacency = buildAdjacency(mesh);
  MeshSummary summary;
  summary.points = mesh.pointCount();
  summary.faces = mesh.faceCount();
  summary.box = usedBox(mesh);
  for (Index f = 0; f < mesh.faceCount(); ++f) ++summary.faceSizes[mesh.faceSize(f)];
  const std::vector<EdgeCorner> edges = cornersByEdge(mesh);
  findComponents(mesh, adjacency, edges, summary);
  countValences(mesh, edges, summary);
  measureBoundary(mesh, edges, summary);

  std::int64_t usedPoints = 0;
  for (const auto& [valence, points] : summary.valences)
    usedPoints += static_cast<std::int64_t>(points);
  summary.eulerCharacteristic = usedPoints - static_cast<std::int64_t>(summary.edges) +
                                static_cast<std::int64_t>(summary.faces);
  summary.defects = findDefects(mesh, adjacency);
  findGenus(summary);
  return summary;
}

std::vector<GridSummary> summarizeVdb(const std::filesystem::path& file) {
  std::vector<GridSummary> summaries;
  forEachGrid(file, [&](const NamedGrid& named) {
    summaries.push_back(summarizeGrid(*named.grid));  // counting voxels takes topology only
  });
  return summaries;
}

}  // namespace vox
