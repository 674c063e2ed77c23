#pragma once

#include "libvox/options/stop_rule.h"
#include "libvox/pipeline/run_submeshes.h"
#include "libvox/subdivide/depth_rule.h"
#include "libvox/subdivide/level.h"
#include "libvox/subdivide/polygon_sink.h"
#include "libvox/subdivide/vertex_array.h"

#include <array>
#include <functional>
#include <memory>
#include <vector>

namespace vox {

/// How deep the refinement of a surface to a stop rule will go, and how many vertices it will make.
struct PolygonPlan {
  Submeshes submeshes;
  std::vector<VertexDepth> depths;  ///< of the level-1 vertex of each corner
  std::shared_ptr<const DepthRule> rule;
  double vertices = 0;  ///< of the arrays of all corners; of thin arrays fewer are made
  int levels = 0;       ///< Doo-Sabin steps down to the deepest vertex
};

/// Largest number of vertices: they take some hours.
inline constexpr double kMostRefinedVertices = 5e10;

/// Finds the depth of every vertex. Parallel; the depths do not depend on submeshes or threads.
/// Credits a part of the current stage of `progress`, and makePolygons the rest.
/// @param base   level 0 in index space: prepared (refine.h); must outlive the plan
/// @param until  with a limit: not untilVoxel(), and levels, if given, at least 1
/// @throws LimitError  coordinates are too large
/// @throws Cancelled
PolygonPlan planPolygons(const SubdivisionLevel& base, const StopRule& until,
                         const SurfaceOptions& options, Progress& progress);

/// Makes the polygons, in pieces that together have no gaps (local_polygons.h), and passes them to
/// sinks. Submeshes, and tiles of large arrays, are tasks. The refined mesh is never in memory as a
/// whole.
/// @param sinkOfThread  returns the sink of the calling thread; pieces come in no particular order
/// @throws LimitError  more than kMostRefinedVertices
/// @throws Cancelled
void makePolygons(const PolygonPlan& plan, Progress& progress,
                  const std::function<PolygonSink&()>& sinkOfThread);

/// All triangles at once. Points of the same place may occur several times.
struct TriangleSoup {
  std::vector<Vec3d> points;  ///< voxels
  std::vector<std::array<Index, 3>> triangles;
};

/// The polygons of a prepared surface in index space, refined to a stop rule such as
/// StopRule{.flatness = 0.1}, as triangles. They follow the order of the submeshes, so the result
/// does not depend on threads.
/// @throws LimitError  2^32 - 1 points or more; as makePolygons
/// @throws Cancelled
TriangleSoup triangleSoup(const SubdivisionLevel& base, const StopRule& until,
                          const SurfaceOptions& options, Progress& progress);

}  // namespace vox
