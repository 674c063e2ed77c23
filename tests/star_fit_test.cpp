// Heights around vertices of dense triangle meshes, against exact closest points of the limit
// surface.

#include "libvox/foot/star_fit.h"

#include "libvox/foot/fit_sums.h"
#include "libvox/mesh/adjacency.h"
#include "libvox/pipeline/joined_vertices.h"
#include "tests/closest_point.h"
#include "tests/repaired_level.h"
#include "tests/shapes.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <hwy/targets.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

using namespace vox;

namespace {

constexpr double kTolerance = 0.01;
constexpr double kLongest = 6;

/// A ring of points around the origin, and one farther out.
struct Star {
  Vec3d centre = Vec3d::Zero();
  std::vector<Vec3d> ring, outer;

  template <class HeightAt>
  Star(std::size_t count, double size, const HeightAt& heightAt) {
    const auto point = [&](double turns, double radius) {
      const double angle = 2 * std::numbers::pi * turns / static_cast<double>(count);
      const double x = radius * std::cos(angle), y = radius * std::sin(angle);
      return Vec3d(x, y, heightAt(x, y));
    };
    centre.z() = heightAt(0, 0);
    for (std::size_t k = 0; k < count; ++k) {
      ring.push_back(point(static_cast<double>(k), size));
      outer.push_back(point(static_cast<double>(k) + 0.5, 1.7 * size));
    }
  }

  std::optional<HeightPatch> fit() const {
    return fitStar({centre, ring, outer}, kLongest, kTolerance);
  }
};

Vec3d pointOf(const HeightPatch& patch, double a, double b) {
  return patch.middle + a * patch.half[0] * patch.axes[0] + b * patch.half[1] * patch.axes[1] +
         heightAt(patch.height, a, b).height * patch.axes[2];
}

bool isWithin(const HeightPatch& patch, double a, double b) {
  return std::all_of(patch.sides.begin(),
                     patch.sides.begin() + static_cast<std::ptrdiff_t>(patch.sideCount),
                     [&](const auto& side) {
                       return side[0] * a * patch.half[0] + side[1] * b * patch.half[1] <= side[2];
                     });
}

}  // namespace

TEST_CASE("heights around vertices lie on the limit surface", "[foot][property]") {
  for (const double jitter : {0.0, 0.03}) {
    CAPTURE(jitter);
    const SubdivisionLevel base = test::repairedLevel(test::wavyTriangles(60, jitter));
    const test::ClosestPoint truth(base, 14);
    const JoinedVertices vertices(base);
    std::vector<Index> corners;
    std::size_t tried = 0, fitted = 0;
    double largest = 0;
    for (Index c = 0; c < base.mesh.cornerCount(); ++c) {
      if (!vertices.setCorners(c, corners) || ++tried % 10 != 0) continue;
      const auto patch = vertices.heightAt(corners, kTolerance);
      if (!patch) continue;
      ++fitted;
      for (const double a : {-0.9, -0.4, 0.1, 0.6})
        for (const double b : {-0.7, 0.0, 0.8})
          if (isWithin(*patch, a, b))
            largest = std::max(largest, truth.of(pointOf(*patch, a, b)).distance);
    }
    CHECK(tried == base.mesh.points.size());
    CHECK(fitted >= tried / 10 / 2);
    CHECK(largest <= 1.5 * kTolerance);
  }
}

TEST_CASE("the corners at a vertex lie within the sides of its height", "[foot][property]") {
  for (const std::size_t count : {5U, 6U, 7U, 8U}) {
    const Star star(count, 1.3, [](double x, double y) { return 0.05 * x * x - 0.03 * x * y; });
    const auto patch = star.fit();
    REQUIRE(patch);
    CHECK(patch->sideCount == count);
    CHECK(patch->axes[0].cross(patch->axes[1]).dot(patch->axes[2]) == Approx(1));
    CHECK(patch->axes[2].z() > 0.9);
    for (std::size_t k = 0; k < count; ++k) {
      const Vec3d &r = star.ring[k], &s = star.ring[(k + 1) % count],
                  &before = star.ring[(k + count - 1) % count];
      const auto image = [](const Vec3d& of, const Vec3d& a, const Vec3d& b) {
        return Vec3d(2.0 / 3 * of + (a + b) / 6.0);  // (3 + 2 cos 0) / 12 + 1/4, (3 - 1) / 12
      };
      const Vec3d& c = star.centre;
      const Vec3d ofEdge =
          (image(c, r, s) + image(r, s, c) + image(c, before, r) + image(r, c, before)) / 4.0;
      for (const Vec3d& p : {Vec3d((c + r + s) / 3.0), ofEdge}) {
        const Vec3d d = p - patch->middle;
        const double a = d.dot(patch->axes[0]) / patch->half[0];
        const double b = d.dot(patch->axes[1]) / patch->half[1];
        CHECK(std::max(std::abs(a), std::abs(b)) <= 1 + 1e-9);
        CHECK(isWithin(*patch, 0.999 * a, 0.999 * b));
      }
    }
  }
}

TEST_CASE("what is no height, steep, or not precise has no height", "[foot]") {
  const auto flat = [](double, double) { return 0.0; };
  CHECK(Star(6, 1, flat).fit());
  CHECK_FALSE(Star(6, 10, flat).fit());  // longer than kLongest
  CHECK_FALSE(Star(6, 0, flat).fit());
  CHECK_FALSE(Star(6, 1e-13, flat).fit());  // its terms would be too large for floats
  CHECK_FALSE(Star(6, std::nan(""), flat).fit());
  CHECK_FALSE(Star(6, 1e300, flat).fit());
  CHECK_FALSE(Star(6, std::numeric_limits<double>::infinity(), flat).fit());
  Star folded(6, 1, flat);
  std::swap(folded.ring[1], folded.ring[2]);
  CHECK_FALSE(folded.fit());
  Star torn(6, 1, flat);
  torn.ring[0].z() += 2;
  CHECK_FALSE(torn.fit());
  Star backward(6, 1, flat);
  std::reverse(backward.ring.begin(), backward.ring.end());
  const auto patch = backward.fit();  // its other side is up; the outer points fit no longer
  CHECK((!patch || patch->axes[2].z() < 0));
  CHECK_FALSE(Star(6, 1, [](double x, double) { return 3 * std::abs(x); }).fit());
}

TEST_CASE("sums of powers are those of a plain loop, on every instruction set", "[foot][simd]") {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> number(-1.2, 1.2);
  PointsToFit points;
  constexpr std::size_t kCount = 25;
  for (std::size_t i = 0; i < kCount; ++i)
    points.set(i, number(random), number(random), number(random));
  const FitSums best = sumsOf(points, kCount);
  for (std::size_t j = 0, m = 0; j < 9; ++j)
    for (std::size_t i = 0; i + j < 9; ++i) {
      double power = 0, height = 0;
      for (std::size_t k = 0; k < kCount; ++k) {
        const double term = std::pow(points.a[k], i) * std::pow(points.b[k], j);
        power += term;
        height += term * points.height[k];
      }
      CHECK(best.powers[j][i] == Approx(power).margin(1e-12));
      if (i + j < 5) CHECK(best.heights[m++] == Approx(height).margin(1e-12));
    }
  std::size_t tried = 0;
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    hwy::GetChosenTarget().Update(target);
    const FitSums sums = sumsOf(points, kCount);
    for (std::size_t j = 0; j < 9; ++j)
      for (std::size_t i = 0; i + j < 9; ++i) CHECK(sums.powers[j][i] == best.powers[j][i]);
    CHECK(sums.heights == best.heights);
    ++tried;
  }
  hwy::GetChosenTarget().DeInit();
  CHECK(tried >= 2);
}
