// The levels at which the normals of neighbouring faces differ by little.

#include "libvox/subdivide/angle_criterion.h"

#include "libvox/subdivide/diameter_criterion.h"
#include "libvox/subdivide/least_depth.h"
#include "libvox/subdivide/patch_steps.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <utility>
#include <vector>

namespace vox {
namespace {

class AngleCriterion : public Criterion {
 public:
  explicit AngleCriterion(double limit) : limit_(limit) {}

  int squareDepth(const Patch& partial, int most) const override {
    const Patch patch = continued(partial);
    const PatchSteps steps(partial);
    constexpr int kMostMeasured = 10;  // if 2^10 rows are not enough, the patch has a fold
    return leastDepth(most, [&](int k) {
      return steps.sizeBelow(k, k) <= 1 ||
             (k <= kMostMeasured && largestAngle(patch, std::int64_t{1} << k) <= limit_);
    });
  }
  VertexDepth regularDepth(const Patch& patch, int most) const override {
    return squareOf(squareDepth(patch, most));
  }
  bool fine(const VertexFaces& faces) const override {
    if (largestDiameter(faces) <= 1) return true;
    const Vec3d r = shapeOf(faces.r).normal;
    const Vec3d l = -shapeOf(faces.l).normal;  // L is given clockwise
    double largest = 0;
    const auto take = [&](bool exist, const Vec3d& a, const Vec3d& b) {
      if (exist) largest = std::max(largest, angleBetween(a, b));
    };
    take(faces.hasR, faces.f.normal, r);
    take(faces.hasL, faces.f.normal, l);
    take(faces.hasR && faces.hasVFace, faces.vFace.normal, r);
    take(faces.hasL && faces.hasVFace, faces.vFace.normal, l);
    return largest <= limit_;
  }
  int creaseDepth(const CurvePoints& points, int most) const override {
    const Vec3d first = points[1] - points[0];
    const Vec3d last = points[2] - points[1];
    const double edge = longestEdge(points);
    const double turn = angleBetween(first.normalized(), last.normalized());
    if (turn == 0 || turn == kStraightAngle) return 0;  // all points lie on a line
    // Directions turn most where edges are shortest: at the point of the line of edges, from the
    // first to the last, that is nearest to 0. There the turn of a step is below bend / shortest.
    const Vec3d bend = last - first;
    const double at = std::clamp(-first.dot(bend) / bend.squaredNorm(), 0.0, 1.0);
    const double shortest = (first + at * bend).norm();
    return leastDepth(most, [&](int k) {
      return std::ldexp(edge, -k) <= 1 ||
             std::ldexp(bend.norm(), -k) <= shortest * limit_ * kRadian;
    });
  }

 private:
  static constexpr double kStraightAngle = 180;
  static constexpr double kRadian = std::numbers::pi / kStraightAngle;

  /// Largest angle, in degrees, between neighbouring faces that touch one of the n x n descendants;
  /// stops at the first angle above the limit. Rows -1 and n, too, are in the closed form.
  double largestAngle(const Patch& patch, std::int64_t n) const {
    std::vector<Vec3d> before, here, normalsBefore, normals;
    double largest = 0;
    for (std::int64_t i = -1; i <= n; ++i) {
      const CurvePoints row = rowOf(patch, PatchWeights(i, n));
      here.clear();
      for (std::int64_t j = -1; j <= n; ++j)
        here.push_back(PatchWeights(j, n)(row[0], row[1], row[2]));
      normals.clear();
      for (std::size_t j = 1; j < before.size(); ++j)
        normals.push_back(normalOf(here[j] - before[j - 1], before[j] - here[j - 1]));
      for (std::size_t j = 1; j < normals.size(); ++j)
        largest = std::max(largest, angleBetween(normals[j - 1], normals[j]));
      for (std::size_t j = 0; j < normalsBefore.size(); ++j)
        largest = std::max(largest, angleBetween(normalsBefore[j], normals[j]));
      if (largest > limit_) return largest;
      std::swap(normals, normalsBefore);
      std::swap(here, before);
    }
    return largest;
  }

  double limit_;
};

}  // namespace

std::unique_ptr<Criterion> angleCriterion(double limit) {
  return std::make_unique<AngleCriterion>(limit);
}

}  // namespace vox
