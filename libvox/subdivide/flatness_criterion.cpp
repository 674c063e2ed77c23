// The levels at which polygons are close to the surface.

#include "libvox/subdivide/flatness_criterion.h"

#include "libvox/mesh/patch_parts.h"
#include "libvox/subdivide/least_depth.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>

namespace vox {
namespace {

double halved(double length, int times) {
  return std::ldexp(length, -times);
}

/// Largest second differences of a patch, measured along its mean normal; their tangential parts
/// count times `sine`.
struct PatchBends {
  double uu = 0, vv = 0, uv = 0;
  double sine = 0;  ///< of the largest angle between the mean normal and another normal

  /// @param patch  with all four faces
  explicit PatchBends(const Patch& patch) {
    const auto& p = patch.points;
    const Vec3d normal = normalOf(p[2][1] - p[0][1], p[1][2] - p[1][0]);
    sine = largestSine(patch, normal);
    const auto take = [&](double& largest, const Vec3d& bend) {
      const double size = bend.norm();
      largest = std::max(largest, std::min(size, std::abs(normal.dot(bend)) + sine * size));
    };
    for (std::size_t i = 0; i < 3; ++i) {
      take(uu, p[0][i] - 2.0 * p[1][i] + p[2][i]);
      take(vv, p[i][0] - 2.0 * p[i][1] + p[i][2]);
    }
    for (std::size_t u = 0; u < 2; ++u)
      for (std::size_t v = 0; v < 2; ++v)
        take(uv, p[u][v] - p[u + 1][v] - p[u][v + 1] + p[u + 1][v + 1]);
  }

 private:
  /// Largest sine of the angles between a normal and the normals of the four faces at their
  /// corners; 1 if one of these angles is 90 degrees or more.
  static double largestSine(const Patch& patch, const Vec3d& normal) {
    const auto& p = patch.points;
    double largest = 0;
    for (std::size_t u = 0; u < 3; ++u)
      for (std::size_t v = 0; v < 3; ++v) {
        const std::size_t a = u == 0 ? 1 : u;
        const std::size_t b = v == 0 ? 1 : v;
        const Vec3d here = normalOf(p[a][v] - p[a - 1][v], p[u][b] - p[u][b - 1]);
        if (!(here.dot(normal) > 0)) return 1;
        largest = std::max(largest, here.cross(normal).norm());
      }
    return largest;
  }
};

class FlatnessCriterion : public Criterion {
 public:
  explicit FlatnessCriterion(double limit) : limit_(limit) {}

  int squareDepth(const Patch& patch, int most) const override {
    constexpr int kMostSplits = 4;
    return squareDepth(continued(patch), most, kMostSplits);
  }
  VertexDepth regularDepth(const Patch& partial, int most) const override {
    const Patch patch = continued(partial);
    const PatchBends bends(patch);
    const VertexDepth apart =
        leastDepths(most, [&](int u, int v) { return fineBelow(bends, u, v); });
    const int square = squareDepth(patch, most);
    return 2 * square < apart.u + apart.v ? squareOf(square) : apart;
  }
  bool fine(const VertexFaces& faces) const override {
    const Vec3d normal = normalOf(faces.next - faces.left, faces.previous - faces.right);
    double height = faces.f.height;
    if (faces.hasVFace) height = std::max(height, faces.vFace.height);
    const auto take = [&](const Vec3d& point) {
      const Vec3d step = point - faces.at;
      height = std::max(height, (normal.isZero() ? step.norm() : std::abs(normal.dot(step))) / 2);
    };
    for (std::size_t i = 1; i < 4; ++i) {
      if (faces.hasR) take(faces.r[i]);
      if (faces.hasL) take(faces.l[i]);
    }
    return height <= limit_;
  }
  int curveDepth(const CurvePoints& points, int most) const override {
    const double bend = (points[0] - 2.0 * points[1] + points[2]).norm();
    return leastDepth(most, [&](int k) { return halved(bend, 2 * k) / 8 <= limit_; });
  }
  int creaseDepth(const CurvePoints& points, int most) const override {
    return curveDepth(points, most);
  }

 private:
  bool fineBelow(const PatchBends& bends, int u, int v) const {
    return (halved(bends.uu, 2 * u) + halved(bends.vv, 2 * v)) / 8 + halved(bends.uv, u + v) / 4 <=
           limit_;
  }

  /// If the patch turns much, measures its children, each along its own normal.
  int squareDepth(const Patch& patch, int most, int splits) const {
    constexpr double kTurnsMuch = 0.1;
    const PatchBends bends(patch);
    const int k = leastDepth(most, [&](int depth) { return fineBelow(bends, depth, depth); });
    if (k < 2 || splits == 0 || bends.sine < kTurnsMuch) return k;
    int below = 0;
    for (const auto& row : childrenOf(patch))
      for (const Patch& child : row) below = std::max(below, squareDepth(child, k - 1, splits - 1));
    return 1 + below;
  }

  double limit_;
};

}  // namespace

std::unique_ptr<Criterion> flatnessCriterion(double limit) {
  return std::make_unique<FlatnessCriterion>(limit);
}

}  // namespace vox
