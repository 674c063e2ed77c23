// Polygons of a surface, submesh by submesh.

#include "libvox/pipeline/refined_polygons.h"

#include "libvox/core/error.h"
#include "libvox/mesh/triangulate.h"
#include "libvox/subdivide/local_polygons.h"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace vox {
namespace {

/// Share of the plan in the work: as measured, little for levels and half for flatness.
constexpr double kPartOfPlan = 0.3;

template <class Body>
void runOnPolygons(const PolygonPlan& plan, Progress& progress, double part, const Body& body) {
  const SubdivisionLevel& base = plan.submeshes.base;
  runSubmeshes(
      plan.submeshes, progress, part, [&] { return LocalPolygons(base); }, body);
}

void requireFeasible(const PolygonPlan& plan) {
  if (plan.vertices <= kMostRefinedVertices) return;
  std::ostringstream message;
  message << "refining to this limit makes about " << plan.vertices
          << " vertices; use fewer levels or a larger limit in --until, or larger voxels";
  throw LimitError(message.str());
}

/// Passes pieces to the sink of the thread, except for large arrays.
class TaskSink : public PolygonSink {
 public:
  TaskSink(const std::function<PolygonSink&()>& sinkOfThread, SubmeshTask& task)
      : sinkOfThread_(sinkOfThread), sink_(sinkOfThread()), task_(task) {}

  void polygons(const PolygonMesh& piece) override {
    task_.progress.check();
    sink_.polygons(piece);
    task_.walked += piece.pointCount();
  }

  void tiles(const ArrayTiles& tiles) override {
    task_.later.push_back({tiles.count(), tiles.vertices(),
                           [&sinkOfThread = sinkOfThread_, tiles](std::int64_t tile) {
                             tiles.emit(tile, sinkOfThread());
                           }});
  }

 private:
  const std::function<PolygonSink&()>& sinkOfThread_;
  PolygonSink& sink_;
  SubmeshTask& task_;
};

void append(const std::vector<Vec3d>& points, std::span<const std::array<Index, 3>> triangles,
            TriangleSoup& soup) {
  const std::size_t first = soup.points.size();
  if (first + points.size() >= kNone)
    throw LimitError("the triangles have more points than fit in 32 bits");
  soup.points.insert(soup.points.end(), points.begin(), points.end());
  for (std::array<Index, 3> triangle : triangles) {
    for (Index& corner : triangle) corner += static_cast<Index>(first);
    soup.triangles.push_back(triangle);
  }
}

class SoupSink : public PolygonSink {
 public:
  TriangleSoup soup;

  void polygons(const PolygonMesh& piece) override {
    triangles_.clear();
    for (Index f = 0; f < piece.faceCount(); ++f) faces_.add(piece, f, triangles_);
    append(piece.points, triangles_, soup);
  }

 private:
  FaceTriangulator faces_;
  std::vector<std::array<Index, 3>> triangles_;  // of a piece
};

}  // namespace

PolygonPlan planPolygons(const SubdivisionLevel& base, const StopRule& until,
                         const SurfaceOptions& options, Progress& progress) {
  PolygonPlan plan{cutIntoSubmeshes(base, options),
                   std::vector<VertexDepth>(base.mesh.cornerCount()),
                   std::make_shared<const DepthRule>(until)};
  runOnPolygons(plan, progress, kPartOfPlan, [&](LocalPolygons& local, SubmeshTask& task) {
    local.findDepths(task.faces, *plan.rule, plan.depths);
  });
  for (const VertexDepth depth : plan.depths) {
    plan.vertices += std::ldexp(1.0, depth.u + depth.v);
    plan.levels = std::max(plan.levels, 1 + std::max<int>(depth.u, depth.v));
  }
  return plan;
}

void makePolygons(const PolygonPlan& plan, Progress& progress,
                  const std::function<PolygonSink&()>& sinkOfThread) {
  requireFeasible(plan);
  runOnPolygons(plan, progress, 1 - kPartOfPlan, [&](LocalPolygons& local, SubmeshTask& task) {
    TaskSink sink(sinkOfThread, task);
    local.emit(task.faces, plan.depths, plan.rule.get(), sink);
  });
}

TriangleSoup triangleSoup(const SubdivisionLevel& base, const StopRule& until,
                          const SurfaceOptions& options, Progress& progress) {
  const PolygonPlan plan = planPolygons(base, until, options, progress);
  requireFeasible(plan);
  std::vector<SoupSink> parts(plan.submeshes.partition.size());
  runOnPolygons(plan, progress, 1 - kPartOfPlan, [&](LocalPolygons& local, SubmeshTask& task) {
    local.emit(task.faces, plan.depths, plan.rule.get(), parts[task.number]);
  });
  TriangleSoup all;
  for (SoupSink& part : parts) {
    append(part.soup.points, part.soup.triangles, all);
    part.soup = {};
  }
  return all;
}

}  // namespace vox
