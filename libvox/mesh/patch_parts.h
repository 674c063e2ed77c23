#pragma once

#include "libvox/mesh/patch.h"

#include <array>

namespace vox {

// A patch looked at in another way, with the same descendants. Patches are complete.

/// The patch seen from another side: u runs against what v was. It has the same vertices and the
/// same outside; rows are what columns were.
Patch quarterTurn(const Patch& patch);

/// The two patches that have the first and the second half of the rows, one level down along u.
std::array<Patch, 2> halvesAlongU(const Patch& patch);

/// The four patches one level below: [u][v].
std::array<std::array<Patch, 2>, 2> childrenOf(const Patch& patch);

}  // namespace vox
