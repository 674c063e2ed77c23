#pragma once

#include "libvox/core/types.h"

#include <vector>

namespace vox {

/// Cosine and sine of an angle. Computed through long double, so that the rounded value does not
/// depend on which of its double-precision kernels the C library picks for the processor.
struct UnitRoot {
  double cosine;
  double sine;
};

/// At the angle 2 pi i / n.
UnitRoot unitRoot(Index i, Index n);

/// All n of them, i = 0 .. n - 1.
std::vector<UnitRoot> unitRoots(Index n);

}  // namespace vox
