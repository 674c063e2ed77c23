#pragma once

#include "libvox/mesh/patch.h"
#include "libvox/subdivide/level.h"

#include <functional>

namespace vox {

/// Emits the vertices that LocalSurface emits for all faces, at the same levels, but builds every
/// level of the whole mesh down to its deepest vertex: the plain algorithm of paper section 2, in
/// double precision. It is slow and needs much memory, but it is simple: tests compare LocalSurface
/// with it. All vertices go to sink.points, except those of thin patches.
///
/// @param base         level 0, in index space
/// @param requireRoom  called before each step with the level that it starts from; may throw
/// @throws LimitError  a level would have 2^32 - 1 corners or more
void emitGlobally(SubdivisionLevel base, SurfaceSink& sink,
                  const std::function<void(const SubdivisionLevel&)>& requireRoom);

}  // namespace vox
