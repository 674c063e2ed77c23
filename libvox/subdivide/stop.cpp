// The depth to which a vertex must be subdivided, computed before it is subdivided.

#include "libvox/subdivide/stop.h"

#include <cmath>

namespace vox {
namespace {

/// Smallest k >= 0 with size 2^-k <= kVertexConversionSpan.
int halvings(double size) {
  int k = 0;
  for (double limit = kVertexConversionSpan; size > limit; limit *= 2) ++k;
  return k;
}

}  // namespace

double contraction(std::size_t sides) {
  switch (sides) {
    case 3:
      return 1.36;
    case 4:
      return 1.25;
    case 5:
      return 1.48;
    case 6:
      return 1.63;
    case 7:
      return 1.68;
    default:
      return 3 - 9.4 / static_cast<double>(sides);
  }
}

bool childrenFineEnough(double largestDiameter, double largestContraction) {
  return largestContraction * largestDiameter <= 2 * kVertexConversionSpan;
}

int patchDepth(const Patch& patch) {
  const PatchSteps steps(patch);
  return halvings((steps.u + steps.v).maxCoeff());
}

int curveDepth(double stripDiameter) {
  constexpr double kMostContraction = 3;
  constexpr double kHalfOfTwice = 2;
  return halvings(kMostContraction * kHalfOfTwice * stripDiameter);
}

}  // namespace vox
