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

/// Bit of a face between index a and a + 1 along u and b and b + 1 along v.
constexpr unsigned faceBit(unsigned a, unsigned b) {
  return 1U << (2 * a + b);
}

/// Largest steps along u and v over the faces that exist.
Vec3d stepsOfExistingFaces(const Patch& patch) {
  Vec3d du = Vec3d::Zero();
  Vec3d dv = Vec3d::Zero();
  const auto& p = patch.points;
  for (unsigned a = 0; a < 2; ++a)
    for (unsigned b = 0; b < 2; ++b) {
      if ((patch.quadrants & faceBit(a, b)) == 0) continue;
      du = du.cwiseMax((p[a + 1][b] - p[a][b]).cwiseAbs());
      du = du.cwiseMax((p[a + 1][b + 1] - p[a][b + 1]).cwiseAbs());
      dv = dv.cwiseMax((p[a][b + 1] - p[a][b]).cwiseAbs());
      dv = dv.cwiseMax((p[a + 1][b + 1] - p[a + 1][b]).cwiseAbs());
    }
  return du + dv;
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
  return halvings(stepsOfExistingFaces(patch).maxCoeff());
}

int curveDepth(double stripDiameter) {
  constexpr double kMostContraction = 3;
  constexpr double kHalfOfTwice = 2;
  return halvings(kMostContraction * kHalfOfTwice * stripDiameter);
}

}  // namespace vox
