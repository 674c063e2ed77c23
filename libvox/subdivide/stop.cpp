// How deep a vertex has to be subdivided, known before it is.

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

double diameter(std::span<const Vec3d> points) {
  Vec3d low = points[0];
  Vec3d high = points[0];
  for (const Vec3d& point : points.subspan(1)) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  return (high - low).maxCoeff();
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
