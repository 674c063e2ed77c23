#pragma once

#include "libvox/core/types.h"
#include "libvox/grid/surface_grid.h"
#include "libvox/subdivide/level.h"
#include "libvox/voxelize/vertex_sink.h"

namespace vox {

/// How a surface is cut into submeshes (paper section 4). The voxels are the same for kBefore and
/// kDuring and any size of submeshes.
enum class Localize {
  kBefore,  ///< submeshes of the prepared mesh, a task each
  kDuring,  ///< besides, patches that have become large are split into tasks of their own
  kOff,     ///< the whole mesh level by level: the plain algorithm, for comparison
};

/// Faces of a submesh: small enough for its level 1 to stay in the second-level cache, large enough
/// for its one-ring to cost little.
inline constexpr Index kDefaultSubmeshFaces = 256;

struct SurfaceOptions {
  Localize localize = Localize::kDuring;
  Index submeshFaces = kDefaultSubmeshFaces;
};

struct SurfaceReport {
  Index submeshes = 0;
  LevelCounts vertices{};  ///< of each level
};

/// Vertex conversion of a prepared surface in index space into a grid: every vertex at the level
/// where the faces around it fit into a voxel. Parallel; the voxels do not depend on the number of
/// threads.
/// @throws LimitError  the grid may not grow; kOff: the whole mesh would be too large
void markSurface(const SubdivisionLevel& base, const SurfaceOptions& options, SurfaceGrid& grid,
                 SurfaceReport& report);

}  // namespace vox
