// The depth of vertices by a stop rule: that of the limit that is met first.

#include "libvox/subdivide/depth_rule.h"

#include "libvox/subdivide/angle_criterion.h"
#include "libvox/subdivide/diameter_criterion.h"
#include "libvox/subdivide/flatness_criterion.h"
#include "libvox/subdivide/irregular_depth.h"
#include "libvox/subdivide/least_depth.h"

#include <algorithm>
#include <cstdint>

namespace vox {
namespace {

VertexDepth depthFor(const Criterion& criterion, const LevelOneVertex& vertex,
                     const VertexFaces* faces, const BoundaryCurves& curves, int most) {
  VertexDepth depth = vertex.regular ? criterion.regularDepth(vertex.around, most)
                                     : squareOf(irregularDepth(criterion, vertex, *faces, most));
  const auto deepen = [&](std::uint8_t& along, const std::optional<CurvePoints>& curve) {
    if (curve)
      along = std::max(along, static_cast<std::uint8_t>(criterion.curveDepth(*curve, most)));
  };
  deepen(depth.u, curves.acrossR);
  deepen(depth.v, curves.acrossL);
  return vertex.regular ? depth : squareOf(std::max(depth.u, depth.v));
}

}  // namespace

DepthRule::DepthRule(const StopRule& rule)
    : most_(rule.levels ? std::max(*rule.levels - 1, 0) : kMostDepth) {
  if (rule.diameter) criteria_.push_back(diameterCriterion(*rule.diameter));
  if (rule.flatness) criteria_.push_back(flatnessCriterion(*rule.flatness));
  if (rule.angle) criteria_.push_back(angleCriterion(*rule.angle));
}

VertexDepth DepthRule::of(const LevelOneVertex& vertex, const VertexFaces* faces,
                          const BoundaryCurves& curves) const {
  VertexDepth least = squareOf(most_);
  for (const auto& criterion : criteria_) {
    const VertexDepth depth = depthFor(*criterion, vertex, faces, curves, most_);
    if (depth.u + depth.v < least.u + least.v) least = depth;
  }
  return least;
}

int DepthRule::ofCrease(const CurvePoints& points) const {
  int least = most_;
  for (const auto& criterion : criteria_)
    least = std::min(least, criterion->creaseDepth(points, least));
  return least;
}

VertexDepth DepthRule::within(const Patch& patch, VertexDepth own) const {
  VertexDepth least = own;
  for (const auto& criterion : criteria_) {
    const VertexDepth depth = criterion->regularDepth(patch, std::max(own.u, own.v));
    if (depth.u + depth.v < least.u + least.v) least = depth;
  }
  return least;
}

}  // namespace vox
