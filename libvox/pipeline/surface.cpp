// Vertex conversion of a surface, submesh by submesh or as a whole.

#include "libvox/pipeline/surface.h"

#include "libvox/core/memory.h"
#include "libvox/core/parallel.h"
#include "libvox/core/progress.h"
#include "libvox/grid/active_voxels.h"
#include "libvox/grid/region.h"
#include "libvox/grid/transform.h"
#include "libvox/mesh/patch_parts.h"
#include "libvox/pipeline/refine.h"
#include "libvox/pipeline/run_submeshes.h"
#include "libvox/subdivide/doo_sabin.h"
#include "libvox/subdivide/fan_vertices.h"
#include "libvox/subdivide/global_surface.h"
#include "libvox/subdivide/local_surface.h"
#include "libvox/subdivide/stop.h"
#include "libvox/voxelize/vertex_sink.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

namespace vox {
namespace {

/// Larger patches are made in tiles: 256 x 256 vertices are some 50 microseconds of work.
constexpr int kMostLevelsOfTile = 8;

/// A voxel that a vertex is rounded to is nearer to it than this, with all errors of computing.
constexpr double kMarginOfMarks = 1;  // voxels

using ThreadSinks = tbb::enumerable_thread_specific<VertexSink>;

/// Tile number `tile` of a patch: one of its 4^levels descendants.
Patch tileOf(Patch patch, int levels, std::int64_t tile) {
  for (int level = levels - 1; level >= 0; --level) {
    const auto child = static_cast<std::size_t>(tile >> (2 * level));
    patch = childrenOf(patch)[child >> 1U & 1U][child & 1U];
  }
  return patch;
}

/// Whether no descendant of a patch can switch on a voxel of a region.
bool isFar(const Region& region, const Patch& patch) {
  if (region.isAll() || patch.quadrants != kAllQuadrants) return false;
  Box hull;
  for (const auto& row : patch.points)
    for (const Vec3d& point : row) hull.add(point);
  hull.low.array() -= kMarginOfMarks;
  hull.high.array() += kMarginOfMarks;
  return !region.meets(hull);
}

/// Passes the vertices of a submesh to the sink of the thread, except for large patches.
class SubmeshSink : public SurfaceSink {
 public:
  SubmeshSink(const Region& region, ThreadSinks& sinks, SubmeshTask& task)
      : region_(region), sinks_(sinks), sink_(sinks.local()), task_(task) {}

  void points(std::span<const Vec3d> points, int level) override { sink_.points(points, level); }
  void curve(const CurvePoints& points, int k, int level) override {
    task_.progress.check();
    sink_.curve(points, k, level);
  }
  void patch(const Patch& patch, int k, int level) override {
    if (isFar(region_, patch)) return;
    const int levels = k - kMostLevelsOfTile;
    if (levels <= 0 || patch.quadrants != kAllQuadrants) return sink_.patch(patch, k, level);
    task_.later.push_back(
        {std::int64_t{1} << (2 * levels), std::ldexp(1.0, 2 * k),
         [&sinks = sinks_, &region = region_, patch, levels, level](std::int64_t tile) {
           const Patch part = tileOf(patch, levels, tile);
           if (!isFar(region, part)) sinks.local().patch(part, kMostLevelsOfTile, level);
         }});
  }

 private:
  const Region& region_;
  ThreadSinks& sinks_;
  VertexSink& sink_;
  SubmeshTask& task_;
};

double verticesOf(const VertexSink& sink) {
  return std::accumulate(sink.vertices().begin(), sink.vertices().end(), 0.0);
}

/// Marks the vertices of dense parts of the mesh.
/// @return  for each vertex of the mesh, whether all that the corners there own is marked
std::vector<std::uint8_t> markFans(const SubdivisionLevel& base, const Region& region,
                                   Progress& progress, ThreadSinks& sinks) {
  std::vector<std::uint8_t> marked(base.mesh.pointCount(), 0);
  tbb::enumerable_thread_specific<FanVertices> fans([&] { return FanVertices(base); });
  const auto isNear = [&](const Vec3d& at) {
    if (region.isAll()) return true;
    const double reach = FanVertices::kReach + kMarginOfMarks;
    return region.meets({at.array() - reach, at.array() + reach});
  };
  parallelForRanges(
      base.mesh.cornerCount(), kElementsPerTask, [&](std::size_t begin, std::size_t end) {
        progress.check();
        FanVertices& fan = fans.local();
        VertexSink& sink = sinks.local();
        for (auto c = static_cast<Index>(begin); c < end; ++c) {
          const Index valence = ledOneRingSize(base.mesh, base.adjacency, c);
          if (valence == 0) continue;
          const Index v = base.mesh.faceVertices[c];
          marked[v] = fan.emit(c, valence, isNear(base.mesh.points[v]) ? &sink : nullptr);
        }
        fan.flush(sink);
      });
  return marked;
}

/// The faces all of whose vertices are marked.
std::vector<std::uint8_t> markedFaces(const PolygonMesh& mesh,
                                      const std::vector<std::uint8_t>& markedVertices) {
  std::vector<std::uint8_t> marked(mesh.faceCount());
  parallelForEach(mesh.faceCount(), kElementsPerTask, [&](Index f) {
    const std::span<const Index> face = mesh.face(f);
    marked[f] = std::all_of(face.begin(), face.end(), [&](Index v) { return markedVertices[v]; });
  });
  return marked;
}

/// @param leftOut  vertices of the mesh whose corners are marked already
/// @param part     the share of this in the current stage of the progress
void markSubmeshes(const Submeshes& submeshes, std::span<const std::uint8_t> leftOut,
                   const Region& region, Progress& progress, double part, ThreadSinks& sinks) {
  const auto walkerOfThread = [&] {
    LocalSurface walker(submeshes.base);
    walker.leaveOut(leftOut);
    return walker;
  };
  runSubmeshes(submeshes, progress, part, walkerOfThread,
               [&](LocalSurface& local, SubmeshTask& task) {
                 SubmeshSink sink(region, sinks, task);
                 const double before = verticesOf(sinks.local());
                 local.emit(task.faces, sink);
                 task.walked = verticesOf(sinks.local()) - before;
               });
}

/// Bytes of the next step, and of the tables that tell which of its vertices are deep enough.
std::uint64_t bytesOfGlobalStep(const SubdivisionLevel& level) {
  constexpr std::uint64_t kPerPoint = sizeof(Vec3d) + sizeof(int) + sizeof(Index) + 1;
  return bytesOf(level) + bytesOfImage(level) + bytesOfNextTopology(level) +
         nextPointCount(level) * kPerPoint + nextCornerCount(level) * sizeof(int);
}

/// Expected number of steps for the whole mesh.
int globalSteps(const PolygonMesh& mesh) {
  double largest = 1;
  std::vector<Vec3d> points;
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    points.clear();
    for (const Index v : mesh.face(f)) points.push_back(mesh.points[v]);
    largest = std::max(largest, diameter(points));
  }
  return 1 + static_cast<int>(std::ceil(std::log2(largest)));
}

void markWhole(const SubdivisionLevel& base, const MemoryBudget& budget, Progress& progress,
               const ActiveVoxels& grid, VertexSink& sink) {
  const int steps = globalSteps(base.mesh);
  int step = 0;
  emitGlobally(base, sink, [&](const SubdivisionLevel& level) {
    progress.check();
    if (step > 0) progress.done(0.75 * std::ldexp(1.0, 2 * (step - steps)));
    ++step;
    budget.require(grid.memoryBytes() + bytesOfGlobalStep(level),
                   "level " + std::to_string(step) + " of the whole mesh",
                   "use --localize during, or larger voxels, or raise --max-memory");
  });
}

}  // namespace

void markSurface(const SubdivisionLevel& base, const SurfaceOptions& options,
                 const MemoryBudget& budget, Progress& progress, ActiveVoxels& grid,
                 SurfaceReport& report) {
  ThreadSinks sinks([&] { return VertexSink(grid); });
  if (options.localize == Localize::kOff) {
    markWhole(base, budget, progress, grid, sinks.local());
  } else {
    const std::vector<std::uint8_t> vertices = markFans(base, grid.region(), progress, sinks);
    const std::vector<std::uint8_t> faces = markedFaces(base.mesh, vertices);
    const auto marked = static_cast<double>(std::count(faces.begin(), faces.end(), 1));
    const double part = marked / base.mesh.faceCount();
    progress.done(part);
    if (part < 1) {
      Submeshes submeshes = cutIntoSubmeshes(base, options, faces);
      skipFarFrom(grid.region(), kMarginOfMarks, submeshes);
      report.submeshes += submeshes.partition.size();
      markSubmeshes(submeshes, vertices, grid.region(), progress, 1 - part, sinks);
    }
  }
  for (VertexSink& sink : sinks) {
    sink.flush();
    for (std::size_t level = 0; level < report.vertices.size(); ++level)
      report.vertices[level] += sink.vertices()[level];
  }
}

}  // namespace vox
