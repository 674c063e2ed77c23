#pragma once

#include "libvox/core/types.h"

#include <vector>

namespace vox {

/// Cosine and sine of an angle. They are computed in long double and then rounded, because the C
/// library picks its double-precision code by processor, with different last bits.
struct UnitRoot {
  double cosine;
  double sine;
};

/// Cosine and sine of the angle 2 pi i / n.
UnitRoot unitRoot(Index i, Index n);

/// Cosines and sines of all n angles 2 pi i / n, i = 0 .. n - 1.
std::vector<UnitRoot> unitRoots(Index n);

}  // namespace vox
