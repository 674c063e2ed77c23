// Counts and properties of meshes and grid files.

#include "libvox/inspect/summary.h"

#include "libvox/core/error.h"
#include "libvox/io/input_file.h"
#include "libvox/io/write_vdb.h"
#include "libvox/mesh/adjacency.h"

#include <openvdb/openvdb.h>

#include <fstream>
#include <numeric>

namespace vox {
namespace {

/// Root of a set in a forest of faces, with path halving.
Index rootOf(std::vector<Index>& parent, Index f) {
  while (parent[f] != f) f = parent[f] = parent[parent[f]];
  return f;
}

void countEdges(const PolygonMesh& mesh, const Adjacency& adjacency, MeshSummary& summary) {
  std::vector<Index> component(mesh.faceCount());
  std::iota(component.begin(), component.end(), 0);
  std::vector<std::uint64_t> valence(mesh.pointCount(), 0);

  forEachEdge(cornersByEdge(mesh, adjacency), [&](std::span<const EdgeCorner> edge) {
    ++summary.edges;
    ++valence[edge[0].low];
    ++valence[edge[0].high];
    for (const EdgeCorner& corner : edge)
      component[rootOf(component, adjacency.cornerFace[corner.corner])] =
          rootOf(component, adjacency.cornerFace[edge[0].corner]);
  });

  for (Index f = 0; f < mesh.faceCount(); ++f) summary.components += component[f] == f;
  for (const auto edges : valence)
    if (edges > 0) ++summary.valences[edges];
}

/// A file of ours names the hash of its content; OpenVDB itself trusts what it reads.
void requireIntact(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw InputError(file.string() + ": cannot be opened; check its permissions");
  if (vdbContent(stream) == VdbContent::kDamaged)
    throw InputError(file.string() + ": is damaged: its content does not match its hash");
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
  for (int axis = 0; axis < 3; ++axis) {
    const auto slot = static_cast<std::size_t>(axis);
    summary.low[slot] = box.min()[axis];
    summary.high[slot] = box.max()[axis];
    summary.voxelSize[slot] = size[axis];
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
  countEdges(mesh, adjacency, summary);
  for (const auto& loop : boundaryLoops(mesh, adjacency))
    summary.boundaryLoops.push_back(loop.size());

  std::int64_t usedPoints = 0;
  for (const auto& [valence, points] : summary.valences)
    usedPoints += static_cast<std::int64_t>(points);
  summary.eulerCharacteristic = usedPoints - static_cast<std::int64_t>(summary.edges) +
                                static_cast<std::int64_t>(summary.faces);
  summary.defects = findDefects(mesh, adjacency);
  return summary;
}

std::vector<GridSummary> summarizeVdb(const std::filesystem::path& file) {
  requireInputFile(file);
  openvdb::initialize();
  openvdb::logging::setLevel(openvdb::logging::Level::Fatal);
  requireIntact(file);
  std::vector<GridSummary> summaries;
  try {
    openvdb::io::File vdb(file.string());
    vdb.open(/*delayLoad=*/true);  // counting voxels takes topology only
    for (auto name = vdb.beginName(); name != vdb.endName(); ++name)
      summaries.push_back(summarizeGrid(*vdb.readGrid(*name)));
  } catch (const std::exception& wrong) {
    constexpr std::size_t kMost = 200;  // damaged files may quote megabytes of themselves
    throw InputError(file.string() +
                     ": cannot be read as OpenVDB: " + std::string(wrong.what()).substr(0, kMost));
  }
  return summaries;
}

}  // namespace vox
