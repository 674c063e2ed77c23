// How deep a vertex has to be subdivided, known before it is.

#include "libvox/subdivide/stop.h"

#include <algorithm>
#include <cmath>

namespace vox {
namespace {

/// Smallest k >= 0 with size 2^-k <= kVertexConversionSpan.
int halvings(double size) {
  int k = 0;
  for (double limit = kVertexConversionSpan; size > limit; limit *= 2) ++k;
  return k;
}

bool fineAt(const PatchSteps& steps, int alongU, int alongV) {
  return steps.sizeBelow(alongU, alongV) <= kVertexConversionSpan;
}

double verticesOf(const PatchDepth& depth) {
  const double array = std::ldexp(1.0, depth.alongU + depth.alongV);
  return depth.elongated() ? array + 4 * std::ldexp(1.0, depth.levels) : array;
}

/// The cheapest depths along the two axes, if they save at least half.
PatchDepth elongatedDepth(const PatchSteps& steps, int levels) {
  const PatchDepth square = {levels, levels, levels};
  PatchDepth best = square;
  for (const int most : {levels, levels + 1})
    for (int least = 0; least < levels; ++least) {
      const PatchDepth wide = {levels, most, least};
      const PatchDepth high = {levels, least, most};
      if (fineAt(steps, most, least) && verticesOf(wide) < verticesOf(best)) best = wide;
      if (fineAt(steps, least, most) && verticesOf(high) < verticesOf(best)) best = high;
    }
  return 2 * verticesOf(best) <= verticesOf(square) ? best : square;
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

PatchDepth patchDepth(const Patch& patch) {
  const PatchSteps steps(patch);
  const int k = halvings((steps.u + steps.v).maxCoeff());
  constexpr int kLeastElongated = 4;  // fewer vertices are not worth it
  if (k < kLeastElongated || patch.quadrants != kAllQuadrants) return {k, k, k};
  constexpr double kAspect = 6;
  const double u = steps.u.maxCoeff();
  const double v = steps.v.maxCoeff();
  const bool square = kAspect * std::min(u, v) > std::max(u, v);
  return square ? PatchDepth{k, k, k} : elongatedDepth(steps, k);
}

int curveDepth(double stripDiameter) {
  constexpr double kMostContraction = 3;
  constexpr double kHalfOfTwice = 2;
  return halvings(kMostContraction * kHalfOfTwice * stripDiameter);
}

}  // namespace vox
