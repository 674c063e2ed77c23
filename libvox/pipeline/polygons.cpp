// Polygons of a level to voxels: paper sections 6 and 7.

#include "libvox/pipeline/polygons.h"

#include "libvox/core/parallel.h"
#include "libvox/grid/leaf_cache.h"
#include "libvox/pipeline/refine.h"
#include "libvox/voxelize/triangulate.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace vox {
namespace {

/// Faces of a part: enough to fill the scan's vector lanes, few enough that large ones are shared
/// out.
constexpr std::size_t kFacesPerPart = 64;

/// One thread's way from faces to voxels.
class PolygonSink {
 public:
  PolygonSink(SurfaceGrid& grid, const PolygonMesh& mesh, Separation separation)
      : cache_(grid), mesh_(mesh), separation_(separation) {}

  void faces(Index begin, Index end) {
    triangles_.clear();
    for (Index f = begin; f != end; ++f) addTriangles(mesh_.face(f));
    scanTriangles(mesh_.points, triangles_, separation_, [this](const VoxelBlock& block) {
      cache_.addBlock({block.origin[0], block.origin[1], block.origin[2]}, block.voxels);
    });
    report_.triangles += triangles_.size();
  }

  void flush() { cache_.flush(); }

  PolygonReport report() const { return {report_.triangles, fans_.fanned}; }

 private:
  void addTriangles(std::span<const Index> face) {
    corners_.clear();
    for (const Index v : face) corners_.push_back(mesh_.points[v]);
    const std::size_t first = triangles_.size();
    triangulate(corners_, triangles_, fans_);
    for (std::size_t t = first; t < triangles_.size(); ++t)
      for (Index& corner : triangles_[t]) corner = face[corner];
  }

  LeafCache cache_;
  const PolygonMesh& mesh_;
  Separation separation_;
  std::vector<Vec3d> corners_;                   // of a face
  std::vector<std::array<Index, 3>> triangles_;  // of a part
  PolygonReport report_;
  TriangulationReport fans_;
};

void scanFaces(const PolygonMesh& mesh, Separation separation, const Progress& progress,
               SurfaceGrid& grid, PolygonReport& report) {
  tbb::enumerable_thread_specific<PolygonSink> sinks(
      [&] { return PolygonSink(grid, mesh, separation); });
  const std::size_t parts = (mesh.faceCount() + kFacesPerPart - 1) / kFacesPerPart;
  forEach(parts, 1, [&](std::size_t part) {
    progress.check();
    const std::size_t begin = part * kFacesPerPart;
    const std::size_t end = std::min<std::size_t>(begin + kFacesPerPart, mesh.faceCount());
    sinks.local().faces(static_cast<Index>(begin), static_cast<Index>(end));
  });
  for (PolygonSink& sink : sinks) {
    sink.flush();
    report.triangles += sink.report().triangles;
    report.fanned += sink.report().fanned;
  }
}

}  // namespace

void markPolygons(SubdivisionLevel base, int levels, Separation separation, MemoryBudget budget,
                  Progress& progress, SurfaceGrid& grid, PolygonReport& report) {
  const std::uint64_t forGrid = budget.left();
  budget.take(grid.memoryBytes(), "the grid", "use larger voxels, or raise --max-memory");
  const PolygonMesh mesh = subdividedWithin(budget, std::move(base), levels, progress).mesh;
  budget.take(bytesOf(mesh), "the refined mesh", "use fewer levels, or raise --max-memory");
  grid.setMemoryLimit(grid.memoryBytes() + budget.left());
  scanFaces(mesh, separation, progress, grid, report);
  grid.setMemoryLimit(forGrid);
}

}  // namespace vox
