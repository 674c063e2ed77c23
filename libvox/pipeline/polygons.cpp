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
#include "libvox/subdivide/image_vertices.h"
#include "libvox/subdivide/next_faces.h"
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

/// Corners of a task that makes faces itself: they lead some 200 faces.
constexpr std::size_t kCornersPerPart = 256;

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

  void polygons(const PolygonMesh& piece) override {
    faces(piece.points, piece, 0, piece.faceCount());
  }

  /// Scans faces of a mesh.
  /// @param points  used in place of the points of the mesh
  void faces(std::span<const Vec3d> points, const PolygonMesh& mesh, Index begin, Index end) {
    triangles_.clear();
    longTriangles_.clear();
    for (Index f = begin; f != end; ++f) {
      const Box box = boxAround(points, mesh.face(f));
      if (!region_.isAll() && !isNear(box)) continue;
      faces_.add(points, mesh.face(f),
                 box.longestSide() <= kLongTriangle ? triangles_ : longTriangles_);
    }
    report_.triangles += triangles_.size() + longTriangles_.size();
    const auto shorter = [&](const auto& triangle) {
      return boxAround(points, triangle).longestSide() <= kLongTriangle;
    };
    const auto middle = std::partition(longTriangles_.begin(), longTriangles_.end(), shorter);
    triangles_.insert(triangles_.end(), longTriangles_.begin(), middle);
    scanTriangles(points, triangles_, separation_, [this](const VoxelBlock& block) { add(block); });
    const auto many = std::vector(middle, longTriangles_.end());
    for (const auto& triangle : many)
      scanInParts({points[triangle[0]], points[triangle[1]], points[triangle[2]]});
  }

  /// Scans the faces of the next level that some corners lead.
  void ledFaces(std::span<const Vec3d> points, const NextFaces& next, Index begin, Index end) {
    piece_.faceOffsets.resize(1);
    piece_.faceVertices.clear();
    for (Index c = begin; c != end; ++c) next.append(c, piece_);
    faces(points, piece_, 0, piece_.faceCount());
  }

  void flush() { cache_.flush(); }

  PolygonReport report() const { return {report_.triangles, faces_.report().fanned}; }

 private:
  using Corners = std::array<Vec3d, 3>;

  static Box boxAround(std::span<const Vec3d> points, std::span<const Index> corners) {
    Box box;
    for (const Index v : corners) box.add(points[v]);
    return box;
  }
  /// Whether a face may meet voxels of the region.
  bool isNear(Box box) const {
    box.low.array() -= 1;
    box.high.array() += 1;
    return region_.meets(box);
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
  std::vector<std::array<Index, 3>> triangles_, longTriangles_;  // of a part
  PolygonMesh piece_;                                            // without points
  PolygonReport report_;
};

/// Calls scan(sink, begin, end) for all ranges of up to `most` of `count` elements.
template <class Scan>
void scanInRanges(std::size_t count, std::size_t most, Progress& progress, ScanSinks& sinks,
                  const Scan& scan) {
  parallelForEach((count + most - 1) / most, 1, [&](std::size_t part) {
    progress.check();
    const std::size_t end = std::min(count, (part + 1) * most);
    scan(sinks.local(), static_cast<Index>(part * most), static_cast<Index>(end));
  });
}

/// Scans the polygons of a level. The last step makes no mesh: only its points, and the faces of a
/// task.
void scanLevel(SubdivisionLevel base, int levels, MemoryBudget& budget, Progress& progress,
               ActiveVoxels& grid, ScanSinks& sinks) {
  const SubdivisionLevel level =
      subdividedWithin(budget, std::move(base), std::max(levels - 1, 0), progress);
  budget.take(bytesOf(level) + (levels > 0 ? bytesOfImage(level) : 0), "the refined mesh",
              "use fewer levels, or raise --max-memory");
  grid.setMemoryLimit(grid.memoryBytes() + budget.left());
  const PolygonMesh& mesh = level.mesh;
  if (levels == 0)
    return scanInRanges(
        mesh.faceCount(), kFacesPerPart, progress, sinks,
        [&](ScanSink& sink, Index begin, Index end) { sink.faces(mesh.points, mesh, begin, end); });
  const std::vector<Vec3d> points = imageVertices(level);
  const NextFaces next(level);
  scanInRanges(
      mesh.cornerCount(), kCornersPerPart, progress, sinks,
      [&](ScanSink& sink, Index begin, Index end) { sink.ledFaces(points, next, begin, end); });
}

/// Whether level 1 is made without submeshes: of a dense mesh, they cost more than its polygons.
bool isWholeCheaper(const SubdivisionLevel& base, const StopRule& until,
                    const MemoryBudget& budget) {
  constexpr Index kDense = 1 << 16;  // faces
  if (until.levels != 1 || base.mesh.faceCount() < kDense || !base.seam.empty()) return false;
  return 2 * (bytesOf(base) + bytesOfImage(base)) < budget.left();
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
