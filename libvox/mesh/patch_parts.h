#pragma once

#include "libvox/mesh/patch.h"

#include <array>

namespace vox {

// Other patches with the descendants of a given patch. Precondition of all but halfTurn: its four
// faces exist.

/// The patch turned by a quarter: the new v runs along the old u, the new u against the old v. The
/// vertices and the outside stay the same; columns become rows.
Patch quarterTurn(const Patch& patch);

/// The patch turned by half a turn: u and v run the other way.
Patch halfTurn(const Patch& patch);

/// One refinement step along u only: the two patches with the first and the second half of the
/// rows.
std::array<Patch, 2> halvesAlongU(const Patch& patch);

/// One refinement step along both axes: the four patches one level down, as [u][v].
std::array<std::array<Patch, 2>, 2> childrenOf(const Patch& patch);

}  // namespace vox
