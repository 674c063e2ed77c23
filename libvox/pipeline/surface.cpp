// Submeshes as tasks that share a grid.

#include "libvox/pipeline/surface.h"

#include "libvox/core/parallel.h"
#include "libvox/localize/partition.h"
#include "libvox/subdivide/global_surface.h"
#include "libvox/subdivide/local_surface.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/task_group.h>

namespace vox {
namespace {

/// Patches of more levels are split: 256 x 256 vertices are some 50 microseconds of work.
constexpr int kMostLevelsOfTask = 8;

using ThreadSinks = tbb::enumerable_thread_specific<VertexSink>;

/// Tasks that split patches as they go, depth first.
class PatchTasks {
 public:
  explicit PatchTasks(ThreadSinks& sinks) : sinks_(sinks) {}
  ~PatchTasks() {
    tasks_.cancel();  // no effect on what is done
    tasks_.wait();
  }

  void add(const Patch& patch, int k, int level) {
    if (k <= kMostLevelsOfTask) return sinks_.local().patch(patch, k, level);
    for (const auto& row : childrenOf(patch))
      for (const Patch& child : row)
        tasks_.run([this, child, k, level] {
          order_.partBegins();
          add(child, k - 1, level);
          order_.partEnds();
        });
  }

  void wait() {
    tasks_.wait();
    order_.loopEnds();
  }

 private:
  ThreadSinks& sinks_;
  LoopOrder order_;
  tbb::task_group tasks_;
};

/// Keeps what is small and makes tasks of what is not.
class SplittingSink : public SurfaceSink {
 public:
  SplittingSink(VertexSink& sink, PatchTasks& tasks) : sink_(sink), tasks_(tasks) {}

  void points(std::span<const Vec3d> points, int level) override { sink_.points(points, level); }
  void curve(const CurvePoints& points, int k, int level) override {
    sink_.curve(points, k, level);
  }
  void patch(const Patch& patch, int k, int level) override {
    if (k > kMostLevelsOfTask && patch.quadrants == kAllQuadrants)
      tasks_.add(patch, k, level);
    else
      sink_.patch(patch, k, level);
  }

 private:
  VertexSink& sink_;
  PatchTasks& tasks_;
};

void markSubmeshes(const SubdivisionLevel& base, const SurfaceOptions& options, ThreadSinks& sinks,
                   SurfaceReport& report) {
  const Partition partition = coverGreedily(base.mesh, base.adjacency, options.submeshFaces);
  report.submeshes += partition.size();
  tbb::enumerable_thread_specific<LocalSurface> surfaces([&] { return LocalSurface(base); });
  PatchTasks tasks(sinks);
  forEach(partition.size(), 1, [&](Index s) {
    SplittingSink splitting(sinks.local(), tasks);
    SurfaceSink& sink = options.localize == Localize::kDuring
                            ? static_cast<SurfaceSink&>(splitting)
                            : static_cast<SurfaceSink&>(sinks.local());
    surfaces.local().emit(partition.submesh(s), sink);
  });
  tasks.wait();
}

}  // namespace

void markSurface(const SubdivisionLevel& base, const SurfaceOptions& options, SurfaceGrid& grid,
                 SurfaceReport& report) {
  ThreadSinks sinks([&] { return VertexSink(grid); });
  if (options.localize == Localize::kOff)
    emitGlobally(base, sinks.local(), [](const SubdivisionLevel&) {});
  else
    markSubmeshes(base, options, sinks, report);
  for (VertexSink& sink : sinks) {
    sink.flush();
    for (std::size_t level = 0; level < report.vertices.size(); ++level)
      report.vertices[level] += sink.vertices()[level];
  }
}

}  // namespace vox
