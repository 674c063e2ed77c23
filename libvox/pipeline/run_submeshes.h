#pragma once

#include "libvox/core/progress.h"
#include "libvox/grid/region.h"
#include "libvox/localize/partition.h"
#include "libvox/options/surface_options.h"
#include "libvox/subdivide/level.h"

#include <tbb/enumerable_thread_specific.h>

#include <cstdint>
#include <functional>
#include <span>
#include <type_traits>
#include <vector>

namespace vox {

/// A surface, cut into submeshes.
struct Submeshes {
  const SubdivisionLevel& base;
  Partition partition;
  bool split;                      ///< tiles of large parts are tasks, which other threads may take
  std::vector<bool> skipped = {};  ///< submeshes that are not walked over; empty: none
};

/// @param base     level 0 in index space; must outlive the result
/// @param leftOut  for each face, whether it is in no submesh; empty: all are in one
Submeshes cutIntoSubmeshes(const SubdivisionLevel& base, const SurfaceOptions& options,
                           std::span<const std::uint8_t> leftOut = {});

/// Skips the submeshes that come nowhere near a region: whose control points, with those of all
/// faces around them, lie in a box that is farther away.
/// @param margin  voxels
void skipFarFrom(const Region& region, double margin, Submeshes& submeshes);

/// A part of a submesh that is too large for one task.
struct LargePart {
  std::int64_t tiles;
  double vertices;  ///< of all tiles
  /// Makes a tile. Called after the walk, once for each tile, in any order and by any thread; so it
  /// may use sinks of threads, but no walker.
  std::function<void(std::int64_t tile)> emit;
};

/// A submesh while its task runs.
struct SubmeshTask {
  Index number;
  std::span<const Index> faces;
  const Progress& progress;           ///< for walks that take long: check() stops them
  std::vector<LargePart> later = {};  ///< what the walk leaves for tiles
  double walked = 0;  ///< vertices of the walk itself; counts only beside those of large parts
};

/// The next function, without walkers.
void runSubmeshes(const Submeshes& submeshes, Progress& progress, double part,
                  const std::function<void(SubmeshTask&)>& walk);

/// Walks over each submesh with body(walker, task), then makes the tiles of its large parts.
/// Parallel. While a thread waits for others, in the walk or for tiles, it starts no other submesh.
///
/// @param part            the share of all this in the current stage of `progress`
/// @param walkerOfThread  makes the walker of a thread, which one body at a time uses
/// @throws Cancelled, and what the bodies and the tiles throw
template <class WalkerOfThread, class Body>
void runSubmeshes(const Submeshes& submeshes, Progress& progress, double part,
                  const WalkerOfThread& walkerOfThread, const Body& body) {
  tbb::enumerable_thread_specific<std::invoke_result_t<WalkerOfThread>> walkers(walkerOfThread);
  runSubmeshes(submeshes, progress, part, [&](SubmeshTask& task) { body(walkers.local(), task); });
}

}  // namespace vox
