// Submeshes as tasks that make polygons.

#include "libvox/pipeline/refined_polygons.h"

#include "libvox/core/error.h"
#include "libvox/core/parallel.h"
#include "libvox/core/progress.h"
#include "libvox/pipeline/surface.h"
#include "libvox/subdivide/local_polygons.h"
#include "libvox/voxelize/triangulate.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>
#include <sstream>

namespace vox {
namespace {

double verticesOf(VertexDepth depth) {
  return std::ldexp(1.0, depth.u + depth.v);
}

void requireFeasible(const PolygonPlan& plan) {
  if (plan.vertices <= kMostRefinedVertices) return;
  std::ostringstream message;
  message << "refining to this limit makes about " << plan.vertices
          << " vertices; use fewer levels or a larger limit in --until, or larger voxels";
  throw LimitError(message.str());
}

/// Passes pieces to the sink of the thread, and shares the tiles of large arrays among all threads.
class TaskSink : public PolygonSink {
 public:
  TaskSink(const std::function<PolygonSink&()>& sinkOfThread, Progress& progress,
           double allVertices)
      : sinkOfThread_(sinkOfThread),
        sink_(sinkOfThread()),
        progress_(progress),
        allVertices_(allVertices) {}

  bool wantsNormals() const override { return sink_.wantsNormals(); }

  void polygons(const PolygonMesh& piece, std::span<const Vec3d> normals) override {
    progress_.check();
    sink_.polygons(piece, normals);
  }

  void tiles(const ArrayTiles& tiles) override {
    const double part = tiles.vertices() / allVertices_ / static_cast<double>(tiles.count());
    // Isolated: while a thread waits for tiles, it must not start another submesh.
    tbb::this_task_arena::isolate([&] {
      parallelForEach(tiles.count(), 1, [&](std::int64_t tile) {
        progress_.check();
        tiles.emit(tile, sinkOfThread_());
        progress_.done(part);
      });
    });
    credited_ += tiles.vertices();
  }

  /// Call after the submesh.
  void finish(double vertices) {
    progress_.done(std::max(0.0, vertices - credited_) / allVertices_);
  }

 private:
  const std::function<PolygonSink&()>& sinkOfThread_;
  PolygonSink& sink_;
  Progress& progress_;
  double allVertices_;
  double credited_ = 0;
};

class SoupSink : public PolygonSink {
 public:
  TriangleSoup soup;

  void polygons(const PolygonMesh& piece, std::span<const Vec3d>) override {
    const std::size_t first = soup.points.size();
    if (first + piece.points.size() >= kNone)
      throw LimitError("the triangles have more points than fit in 32 bits");
    soup.points.insert(soup.points.end(), piece.points.begin(), piece.points.end());
    for (Index f = 0; f < piece.faceCount(); ++f) {
      const auto face = piece.face(f);
      corners_.clear();
      for (const Index v : face) corners_.push_back(piece.points[v]);
      const std::size_t before = soup.triangles.size();
      triangulate(corners_, soup.triangles, fans_);
      for (std::size_t t = before; t < soup.triangles.size(); ++t)
        for (Index& corner : soup.triangles[t]) corner = static_cast<Index>(first) + face[corner];
    }
  }

 private:
  std::vector<Vec3d> corners_;
  TriangulationReport fans_;
};

}  // namespace

PolygonPlan planPolygons(const SubdivisionLevel& base, const StopRule& until, Index submeshFaces,
                         const Progress& progress) {
  PolygonPlan plan;
  plan.partition = coverGreedily(base.mesh, base.adjacency, submeshFaces);
  plan.depths.resize(base.mesh.cornerCount());
  plan.rule = std::make_shared<const DepthRule>(until);
  tbb::enumerable_thread_specific<LocalPolygons> locals([&] { return LocalPolygons(base); });
  parallelForEach(plan.partition.size(), 1, [&](Index s) {
    progress.check();
    locals.local().findDepths(plan.partition.submesh(s), *plan.rule, plan.depths);
  });
  for (const VertexDepth depth : plan.depths) {
    plan.vertices += verticesOf(depth);
    plan.levels = std::max(plan.levels, 1 + std::max<int>(depth.u, depth.v));
  }
  return plan;
}

void makePolygons(const SubdivisionLevel& base, const PolygonPlan& plan, Progress& progress,
                  const std::function<PolygonSink&()>& sinkOfThread) {
  requireFeasible(plan);
  tbb::enumerable_thread_specific<LocalPolygons> locals([&] { return LocalPolygons(base); });
  parallelForEach(plan.partition.size(), 1, [&](Index s) {
    const auto faces = plan.partition.submesh(s);
    TaskSink sink(sinkOfThread, progress, plan.vertices);
    locals.local().emit(faces, plan.depths, plan.rule.get(), sink);
    double vertices = 0;
    for (const Index f : faces)
      for (Index c = base.mesh.faceOffsets[f]; c < base.mesh.faceOffsets[f + 1]; ++c)
        vertices += verticesOf(plan.depths[c]);
    sink.finish(vertices);
  });
}

TriangleSoup triangleSoup(const SubdivisionLevel& base, const StopRule& until, Progress& progress) {
  const PolygonPlan plan = planPolygons(base, until, kDefaultSubmeshFaces, progress);
  requireFeasible(plan);
  std::vector<SoupSink> parts(plan.partition.size());
  tbb::enumerable_thread_specific<LocalPolygons> locals([&] { return LocalPolygons(base); });
  parallelForEach(plan.partition.size(), 1, [&](Index s) {
    progress.check();
    locals.local().emit(plan.partition.submesh(s), plan.depths, plan.rule.get(), parts[s]);
  });
  TriangleSoup all;
  for (SoupSink& part : parts) {
    const std::size_t first = all.points.size();
    if (first + part.soup.points.size() >= kNone)
      throw LimitError("the triangles have more points than fit in 32 bits");
    all.points.insert(all.points.end(), part.soup.points.begin(), part.soup.points.end());
    for (std::array<Index, 3> triangle : part.soup.triangles) {
      for (Index& corner : triangle) corner += static_cast<Index>(first);
      all.triangles.push_back(triangle);
    }
    part.soup = {};
  }
  return all;
}

}  // namespace vox
