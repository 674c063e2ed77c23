#pragma once

#include "libvox/core/progress.h"
#include "libvox/localize/partition.h"
#include "libvox/options/stop_rule.h"
#include "libvox/subdivide/depth_rule.h"
#include "libvox/subdivide/level.h"
#include "libvox/subdivide/polygon_sink.h"
#include "libvox/subdivide/vertex_array.h"

#include <array>
#include <functional>
#include <memory>
#include <vector>

namespace vox {

/// What refining a surface to a stop rule will make, known before it is made.
struct PolygonPlan {
  Partition partition;              ///< submeshes
  std::vector<VertexDepth> depths;  ///< of the level-1 vertex of each corner
  std::shared_ptr<const DepthRule> rule;
  double vertices = 0;  ///< of all these arrays; where they are thin, fewer are made
  int levels = 0;       ///< Doo-Sabin steps down to the deepest vertex
};

/// More polygons than anybody waits for: some hours.
inline constexpr double kMostRefinedVertices = 5e10;

/// Finds the depths. Parallel; they do not depend on submeshes or threads.
/// @param base   level 0 in index space: prepared (refine.h)
/// @param until  with a limit: not untilVoxel(), and levels, if given, at least 1
/// @throws LimitError  coordinates out of all range
/// @throws Cancelled
PolygonPlan planPolygons(const SubdivisionLevel& base, const StopRule& until, Index submeshFaces,
                         const Progress& progress);

/// Makes the polygons, in pieces that together have no gaps (local_polygons.h), submeshes and tiles
/// of large arrays as tasks. Nothing of the refined mesh stays. Credits the current stage of
/// `progress`.
/// @param sinkOfThread  called often; one sink per thread. Pieces come in no particular order
/// @throws LimitError  more than kMostRefinedVertices
/// @throws Cancelled
void makePolygons(const SubdivisionLevel& base, const PolygonPlan& plan, Progress& progress,
                  const std::function<PolygonSink&()>& sinkOfThread);

/// Triangles for programs that want all of them at once: `points` may repeat.
struct TriangleSoup {
  std::vector<Vec3d> points;  ///< voxels
  std::vector<std::array<Index, 3>> triangles;
};

/// A prepared surface in index space as triangles that nowhere keep farther from the smooth surface
/// than the rule says: StopRule{.flatness = 0.1}, say. Pieces follow the order of the submeshes, so
/// the result does not depend on threads.
/// @throws LimitError  2^32 - 1 points or more; as makePolygons
/// @throws Cancelled
TriangleSoup triangleSoup(const SubdivisionLevel& base, const StopRule& until, Progress& progress);

}  // namespace vox
