// Polygons to voxels: paper sections 6 and 7.

#include "libvox/pipeline/polygons.h"

#include "libvox/core/memory.h"
#include "libvox/core/parallel.h"
#include "libvox/core/progress.h"
#include "libvox/grid/active_voxels.h"
#include "libvox/grid/leaf_cache.h"
#include "libvox/grid/region.h"
#include "libvox/grid/transform.h"
#include "libvox/mesh/triangulate.h"
#include "libvox/options/voxelize.h"
#include "libvox/pipeline/refine.h"
#include "libvox/pipeline/refined_polygons.h"
#include "libvox/voxelize/scan.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <array>
#include <span>
#include <utility>
#include <vector>

namespace vox {
namespace {

/// Faces of a task: enough to fill the scan's vector lanes, few enough that large faces are shared
/// among threads.
constexpr std::size_t kFacesPerPart = 64;

/// Triangles that are longer, in voxels, are scanned in parts.
constexpr double kLongTriangle = 512;

class ScanSink;
using ScanSinks = tbb::enumerable_thread_specific<ScanSink>;

/// Scans faces into the grid; one for each thread.
class ScanSink : public PolygonSink {
 public:
  ScanSink(ActiveVoxels& grid, Separation separation, const Progress& progress, ScanSinks& all)
      : cache_(grid),
        region_(grid.region()),
        separation_(separation),
        progress_(progress),
        all_(all) {}

  void polygons(const PolygonMesh& piece) override { faces(piece, 0, piece.faceCount()); }

  void faces(const PolygonMesh& mesh, Index begin, Index end) {
    triangles_.clear();
    for (Index f = begin; f != end; ++f)
      if (region_.isAll() || isNear(mesh, f)) faces_.add(mesh, f, triangles_);
    report_.triangles += triangles_.size();
    const auto middle = std::stable_partition(
        triangles_.begin(), triangles_.end(),
        [&](const auto& triangle) { return !isLong(cornersOf(mesh, triangle)); });
    const auto longOnes = static_cast<std::size_t>(triangles_.end() - middle);
    scanTriangles(mesh.points, std::span(triangles_).first(triangles_.size() - longOnes),
                  separation_, [this](const VoxelBlock& block) { add(block); });
    const auto many = std::vector(middle, triangles_.end());
    for (const auto& triangle : many) scanInParts(cornersOf(mesh, triangle));
  }

  void flush() { cache_.flush(); }

  PolygonReport report() const { return {report_.triangles, faces_.report().fanned}; }

 private:
  using Corners = std::array<Vec3d, 3>;

  static Corners cornersOf(const PolygonMesh& mesh, const std::array<Index, 3>& triangle) {
    return {mesh.points[triangle[0]], mesh.points[triangle[1]], mesh.points[triangle[2]]};
  }
  /// Whether a face may meet voxels of the region.
  bool isNear(const PolygonMesh& mesh, Index face) const {
    Box box = boxOf(mesh, std::span(&face, 1));
    box.low.array() -= 1;
    box.high.array() += 1;
    return region_.meets(box);
  }
  static bool isLong(const Corners& corners) {
    const Vec3d low = corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]);
    const Vec3d high = corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]);
    return !((high - low).maxCoeff() <= kLongTriangle);
  }

  void add(const VoxelBlock& block) {
    cache_.addBlock({block.origin[0], block.origin[1], block.origin[2]}, block.voxels);
  }

  /// Isolated: while a thread waits for the others, it must not start another piece.
  void scanInParts(const Corners& corners) {
    tbb::this_task_arena::isolate([&] {
      parallelForEach(scanPartCount(corners), 1, [&](std::int64_t part) {
        progress_.check();
        ScanSink& sink = all_.local();
        scanTrianglePart(corners, part, separation_,
                         [&sink](const VoxelBlock& block) { sink.add(block); });
      });
    });
  }

  LeafCache cache_;
  const Region& region_;
  Separation separation_;
  const Progress& progress_;
  ScanSinks& all_;
  FaceTriangulator faces_;
  std::vector<std::array<Index, 3>> triangles_;  // of a part
  PolygonReport report_;
};

void scanFaces(const PolygonMesh& mesh, Progress& progress, ScanSinks& sinks) {
  const std::size_t parts = (mesh.faceCount() + kFacesPerPart - 1) / kFacesPerPart;
  parallelForEach(parts, 1, [&](std::size_t part) {
    progress.check();
    const std::size_t begin = part * kFacesPerPart;
    const std::size_t end = std::min<std::size_t>(begin + kFacesPerPart, mesh.faceCount());
    sinks.local().faces(mesh, static_cast<Index>(begin), static_cast<Index>(end));
  });
}

/// Scans the whole mesh of a level.
void scanLevel(SubdivisionLevel base, int levels, MemoryBudget& budget, Progress& progress,
               ActiveVoxels& grid, ScanSinks& sinks) {
  const PolygonMesh mesh = subdividedWithin(budget, std::move(base), levels, progress).mesh;
  budget.take(bytesOf(mesh), "the refined mesh", "use fewer levels, or raise --max-memory");
  grid.setMemoryLimit(grid.memoryBytes() + budget.left());
  scanFaces(mesh, progress, sinks);
}

/// Whether level 1 is built as a whole: of a dense mesh, submeshes cost more than its polygons.
bool isWholeCheaper(const SubdivisionLevel& base, const StopRule& until,
                    const MemoryBudget& budget) {
  constexpr Index kDense = 1 << 16;  // faces
  if (until.levels != 1 || base.mesh.faceCount() < kDense || !base.seam.empty()) return false;
  const std::uint64_t level = bytesOf(base) + bytesOfImage(base) + bytesOfNextTopology(base);
  return 2 * level < budget.left();
}

}  // namespace

void markPolygons(SubdivisionLevel base, const StopRule& until, const SurfaceOptions& options,
                  Separation separation, MemoryBudget budget, Progress& progress,
                  ActiveVoxels& grid, PolygonReport& report) {
  const std::uint64_t forGrid = budget.left();
  budget.take(grid.memoryBytes(), "the grid", "use larger voxels, or raise --max-memory");
  ScanSinks sinks([&] { return ScanSink(grid, separation, progress, sinks); });
  const bool levelsOnly = until == StopRule{until.levels};
  const bool isWhole =
      options.localize == Localize::kOff ||
      (options.localize == Localize::kDuring && isWholeCheaper(base, until, budget));
  if (until.levels == 0 || (levelsOnly && isWhole)) {
    report.levels = *until.levels;
    scanLevel(std::move(base), report.levels, budget, progress, grid, sinks);
  } else {
    const PolygonPlan plan = planPolygons(base, until, options, progress);
    report.levels = plan.levels;
    report.submeshes = plan.submeshes.partition.size();
    makePolygons(plan, progress, [&]() -> PolygonSink& { return sinks.local(); });
  }
  for (ScanSink& sink : sinks) {
    sink.flush();
    report.triangles += sink.report().triangles;
    report.fanned += sink.report().fanned;
  }
  grid.setMemoryLimit(forGrid);
}

}  // namespace vox
