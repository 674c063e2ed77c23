#pragma once

#include "libvox/mesh/patch.h"
#include "libvox/subdivide/level.h"

#include <functional>

namespace vox {

/// The same vertices as LocalSurface emits for all faces, at the same levels, found by subdividing
/// the whole mesh as deep as its deepest vertex: the plain algorithm of paper section 2, in double
/// precision, which builds every level. Slow and large, but simple: what LocalSurface is held
/// against. All vertices are given to sink.points.
///
/// @param requireRoom  called before each step with the level it starts from; may throw
/// @throws LimitError  a level would have 2^32 - 1 corners or more; whatever requireRoom throws
void emitGlobally(SubdivisionLevel base, SurfaceSink& sink,
                  const std::function<void(const SubdivisionLevel&)>& requireRoom);

}  // namespace vox
