#pragma once

#include "libvox/core/memory.h"
#include "libvox/core/progress.h"
#include "libvox/core/types.h"
#include "libvox/grid/active_voxels.h"
#include "libvox/subdivide/level.h"
#include "libvox/voxelize/vertex_sink.h"

#include <optional>
#include <string>
#include <string_view>

namespace vox {

/// How a surface is cut into submeshes (paper section 4). The voxels are the same for kBefore and
/// kDuring and any size of submeshes.
enum class Localize {
  kBefore,  ///< submeshes of the prepared mesh, a task each
  kDuring,  ///< besides, patches that have become large are split into tasks of their own
  kOff,     ///< the whole mesh level by level: the plain algorithm, for comparison
};

/// Names on the command line: "during".
std::string localizeName(Localize localize);
/// Value of that name, or nothing.
std::optional<Localize> localizeNamed(std::string_view name);
/// For messages: "before, during, off".
std::string allLocalizeNames();

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
/// threads. Credits the current stage of `progress` with its parts.
///
/// @param budget  what kOff may use for its meshes
/// @throws LimitError  the grid may not grow; kOff: the whole mesh would be too large
/// @throws Cancelled
void markSurface(const SubdivisionLevel& base, const SurfaceOptions& options,
                 const MemoryBudget& budget, Progress& progress, ActiveVoxels& grid,
                 SurfaceReport& report);

}  // namespace vox
