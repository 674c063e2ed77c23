// The levels at which faces are as small as a limit.

#include "libvox/subdivide/diameter_criterion.h"

#include "libvox/subdivide/least_depth.h"
#include "libvox/subdivide/stop.h"

#include <algorithm>
#include <cmath>

namespace vox {
namespace {

class DiameterCriterion : public Criterion {
 public:
  explicit DiameterCriterion(double limit) : limit_(limit) {}

  int squareDepth(const Patch& patch, int most) const override {
    const PatchSteps steps(patch);
    return leastDepth(most, [&](int k) { return steps.sizeBelow(k, k) <= limit_; });
  }
  VertexDepth regularDepth(const Patch& patch, int most) const override {
    const PatchSteps steps(patch);
    return leastDepths(most, [&](int u, int v) { return steps.sizeBelow(u, v) <= limit_; });
  }
  bool fine(const VertexFaces& faces) const override { return largestDiameter(faces) <= limit_; }
  int creaseDepth(const CurvePoints& points, int most) const override {
    const double edge = longestEdge(points);
    return leastDepth(most, [&](int k) { return std::ldexp(edge, -k) <= limit_; });
  }

 private:
  double limit_;
};

}  // namespace

double largestDiameter(const VertexFaces& faces) {
  double size = faces.f.diameter;
  if (faces.hasVFace) size = std::max(size, faces.vFace.diameter);
  if (faces.hasR) size = std::max(size, diameter(faces.r));
  if (faces.hasL) size = std::max(size, diameter(faces.l));
  return size;
}

std::unique_ptr<Criterion> diameterCriterion(double limit) {
  return std::make_unique<DiameterCriterion>(limit);
}

}  // namespace vox
