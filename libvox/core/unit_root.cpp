// Cosines and sines with the same bits on every processor.

#include "libvox/core/unit_root.h"

#include <cmath>
#include <numbers>

namespace vox {

UnitRoot unitRoot(Index i, Index n) {
  const long double angle = 2 * std::numbers::pi_v<long double> * i / n;
  return {static_cast<double>(std::cos(angle)), static_cast<double>(std::sin(angle))};
}

std::vector<UnitRoot> unitRoots(Index n) {
  std::vector<UnitRoot> roots(n);
  for (Index i = 0; i < n; ++i) roots[i] = unitRoot(i, n);
  return roots;
}

}  // namespace vox
