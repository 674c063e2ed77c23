// Submeshes as tasks that share a grid.

#include "libvox/pipeline/surface.h"

#include "libvox/core/memory.h"
#include "libvox/core/parallel.h"
#include "libvox/core/progress.h"
#include "libvox/grid/active_voxels.h"
#include "libvox/localize/partition.h"
#include "libvox/mesh/area.h"
#include "libvox/mesh/patch_parts.h"
#include "libvox/pipeline/refine.h"
#include "libvox/pipeline/work.h"
#include "libvox/subdivide/doo_sabin.h"
#include "libvox/subdivide/global_surface.h"
#include "libvox/subdivide/local_surface.h"
#include "libvox/subdivide/stop.h"
#include "libvox/voxelize/vertex_sink.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/task_group.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <mutex>
#include <numeric>
#include <utility>
#include <vector>

namespace vox {
namespace {

/// Patches of more levels are split: 256 x 256 vertices are some 50 microseconds of work.
constexpr int kMostLevelsOfTask = 8;

using ThreadSinks = tbb::enumerable_thread_specific<VertexSink>;

/// The share of a submesh in the work. It is credited to the progress in proportion to the vertices
/// that are made. Their total is known only after the last patch; work done until then is credited
/// at that time.
class SubmeshPart {
 public:
  SubmeshPart(Progress& progress, double part) : progress_(progress), part_(part) {}

  /// Some vertices are made.
  void add(double vertices) { credit(vertices, 0); }
  /// The total is known.
  void setTotal(double vertices) { credit(0, std::max(1.0, vertices)); }

 private:
  void credit(double vertices, double all) {
    double part = 0;
    {
      const std::scoped_lock lock(mutex_);
      keptBack_ += vertices;
      if (all > 0) perVertex_ = part_ / all;
      if (perVertex_ > 0) part = perVertex_ * std::exchange(keptBack_, 0);
    }
    if (part > 0) progress_.done(part);
  }

  Progress& progress_;
  double part_;
  std::mutex mutex_;
  double keptBack_ = 0;   // vertices
  double perVertex_ = 0;  // 0: not known yet
};

/// A patch that is to be subdivided k times.
struct DeepPatch {
  Patch patch;
  int k;
  int level;
  std::shared_ptr<SubmeshPart> part;

  double vertices() const { return std::ldexp(1.0, 2 * k); }
};

/// Splits deep patches into parts that are small enough for a task, depth first.
class DeepPatches {
 public:
  /// @param asTasks  parts of a patch are tasks, which other threads may take
  DeepPatches(ThreadSinks& sinks, Progress& progress, bool asTasks)
      : sinks_(sinks), progress_(progress), asTasks_(asTasks) {}
  ~DeepPatches() {
    tasks_.cancel();  // no effect on tasks that are done
    try {
      tasks_.wait();
    } catch (...) {
      // The exception that stopped this thread is already on its way to the caller.
    }
  }
  DeepPatches(const DeepPatches&) = delete;
  DeepPatches& operator=(const DeepPatches&) = delete;

  bool asTasks() const { return asTasks_; }
  /// @throws Cancelled
  void check() const { progress_.check(); }

  void mark(const DeepPatch& deep) {
    progress_.check();
    if (deep.k <= kMostLevelsOfTask) {
      sinks_.local().patch(deep.patch, deep.k, deep.level);
      deep.part->add(deep.vertices());
      return;
    }
    for (const auto& row : childrenOf(deep.patch))
      for (const Patch& child : row) {
        const DeepPatch part{child, deep.k - 1, deep.level, deep.part};
        if (asTasks_)
          tasks_.run(order_.task([this, part] { mark(part); }));
        else
          mark(part);
      }
  }

  /// Waits until all are marked.
  /// @throws the exception that marking one of them threw
  void wait() { tasks_.wait(); }

 private:
  ThreadSinks& sinks_;
  Progress& progress_;
  bool asTasks_;
  LoopOrder order_;
  tbb::task_group tasks_;
};

/// Passes the small patches of a submesh to the sink of the thread. Deep patches are split.
class SubmeshSink : public SurfaceSink {
 public:
  SubmeshSink(VertexSink& sink, DeepPatches& deepPatches, std::shared_ptr<SubmeshPart> part)
      : sink_(sink),
        deepPatches_(deepPatches),
        part_(std::move(part)),
        verticesBefore_(verticesOf(sink)) {}

  void points(std::span<const Vec3d> points, int level) override { sink_.points(points, level); }
  void curve(const CurvePoints& points, int k, int level) override {
    if (k > kMostLevelsOfTask) deepPatches_.check();
    sink_.curve(points, k, level);
  }
  void patch(const Patch& patch, int k, int level) override {
    if (k <= kMostLevelsOfTask || patch.quadrants != kAllQuadrants) {
      sink_.patch(patch, k, level);
      return;
    }
    const DeepPatch deep{patch, k, level, part_};
    deepVertices_ += deep.vertices();
    if (deepPatches_.asTasks())
      deepPatches_.mark(deep);
    else
      later_.push_back(deep);
  }

  /// Call after the last patch.
  void finish() {
    const double here = verticesOf(sink_) - verticesBefore_;
    part_->setTotal(here + deepVertices_);
    part_->add(here);
    for (const DeepPatch& deep : later_) deepPatches_.mark(deep);
  }

 private:
  static double verticesOf(const VertexSink& sink) {
    return std::accumulate(sink.vertices().begin(), sink.vertices().end(), 0.0);
  }

  VertexSink& sink_;
  DeepPatches& deepPatches_;
  std::shared_ptr<SubmeshPart> part_;
  std::vector<DeepPatch> later_;
  double verticesBefore_;
  double deepVertices_ = 0;
};

/// Share of each submesh in the work. The shares add up to 1.
std::vector<double> partsOf(const Partition& partition, const PolygonMesh& mesh) {
  std::vector<double> parts(partition.size(), 0.0);
  constexpr std::size_t kSubmeshesPerTask = 16;
  parallelForEach(partition.size(), kSubmeshesPerTask, [&](Index s) {
    for (const Index f : partition.submesh(s))
      parts[s] += workOfSurface(areaOf(mesh, f), mesh.faceSize(f));
  });
  const double all = std::accumulate(parts.begin(), parts.end(), 0.0);
  for (double& part : parts) part /= all;
  return parts;
}

void markSubmeshes(const SubdivisionLevel& base, const SurfaceOptions& options, Progress& progress,
                   ThreadSinks& sinks, SurfaceReport& report) {
  const Partition partition = coverGreedily(base.mesh, base.adjacency, options.submeshFaces);
  report.submeshes += partition.size();
  const std::vector<double> parts =
      progress.watched() ? partsOf(partition, base.mesh) : std::vector<double>(partition.size());
  tbb::enumerable_thread_specific<LocalSurface> surfaces([&] { return LocalSurface(base); });
  DeepPatches deepPatches(sinks, progress, options.localize == Localize::kDuring);
  parallelForEach(partition.size(), 1, [&](Index s) {
    progress.check();
    SubmeshSink sink(sinks.local(), deepPatches, std::make_shared<SubmeshPart>(progress, parts[s]));
    surfaces.local().emit(partition.submesh(s), sink);
    sink.finish();
  });
  deepPatches.wait();
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
  if (options.localize == Localize::kOff)
    markWhole(base, budget, progress, grid, sinks.local());
  else
    markSubmeshes(base, options, progress, sinks, report);
  for (VertexSink& sink : sinks) {
    sink.flush();
    for (std::size_t level = 0; level < report.vertices.size(); ++level)
      report.vertices[level] += sink.vertices()[level];
  }
}

}  // namespace vox
