#include "libvox/mesh/triangulate.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <random>
#include <string>
#include <utility>

using namespace vox;

namespace {

using Triangles = std::vector<std::array<Index, 3>>;

struct Triangulated {
  Triangles triangles;
  std::uint64_t fanned;
};

Triangulated triangulated(const std::vector<Vec3d>& corners) {
  Triangulated result;
  TriangulationReport report;
  triangulate(corners, result.triangles, report);
  result.fanned = report.fanned;
  return result;
}

Vec3d areaVector(const Vec3d& a, const Vec3d& b, const Vec3d& c) {
  return (b - a).cross(c - a) / 2;
}

Vec3d areaVector(const std::vector<Vec3d>& polygon) {
  Vec3d area = Vec3d::Zero();
  for (std::size_t i = 0; i < polygon.size(); ++i)
    area += polygon[i].cross(polygon[(i + 1) % polygon.size()]) / 2;
  return area;
}

/// Whether the triangles form a disk with the polygon as its rim: there are n - 2; each side of the
/// polygon is used once, in its direction; each diagonal is used once in both directions.
bool isDisk(const Triangles& triangles, std::size_t n) {
  if (triangles.size() != n - 2) return false;
  std::map<std::pair<Index, Index>, int> uses;
  for (const auto& t : triangles)
    for (std::size_t i = 0; i < 3; ++i) ++uses[{t[i], t[(i + 1) % 3]}];
  return std::all_of(uses.begin(), uses.end(), [&](const auto& use) {
    const auto [from, to] = use.first;
    const bool side = to == (from + 1) % n;
    return use.second == 1 && (side || uses.count({to, from}) == 1);
  });
}

/// Sum of the absolute areas of the triangles, projected along the normal of the polygon, divided
/// by the area of the polygon.
double coverage(const std::vector<Vec3d>& polygon, const Triangles& triangles) {
  const Vec3d area = areaVector(polygon);
  double covered = 0;
  for (const auto& t : triangles)
    covered +=
        std::abs(areaVector(polygon[t[0]], polygon[t[1]], polygon[t[2]]).dot(area.normalized()));
  return covered / area.norm();
}

/// Of two ears, the better one has the larger sine of its smallest angle, in steps of 1/256, or at
/// equal sines the shorter diagonal.
std::pair<int, double> earQuality(const std::vector<Vec3d>& corners,
                                  const std::array<Index, 3>& ear) {
  double least = 1;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3d a = corners[ear[(i + 1) % 3]] - corners[ear[i]];
    const Vec3d b = corners[ear[(i + 2) % 3]] - corners[ear[i]];
    least = std::min(least, a.cross(b).norm() / (a.norm() * b.norm()));
  }
  return {static_cast<int>(256 * least), -(corners[ear[2]] - corners[ear[0]]).norm()};
}

std::vector<Vec3d> star(std::size_t n, std::mt19937& random) {
  std::uniform_real_distribution<double> radius(0.1, 1);
  std::vector<Vec3d> corners;
  for (std::size_t i = 0; i < n; ++i) {
    const double t = 2 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(n);
    const double r = radius(random);
    corners.emplace_back(r * std::cos(t), r * std::sin(t), 0);
  }
  return corners;
}

/// The outline of a spiral band: out along one edge and back along the other.
std::vector<Vec3d> spiral(std::size_t n) {
  std::vector<Vec3d> corners;
  const std::size_t half = n / 2;
  const double turns = std::max(1.0, static_cast<double>(half) / 100);
  const auto at = [&](std::size_t i, double inset) {
    const double s = static_cast<double>(i) / static_cast<double>(half);
    const double t = 2 * std::numbers::pi * turns * s;
    const double r = 0.3 + turns * s - inset;
    corners.emplace_back(r * std::cos(t), r * std::sin(t), 0);
  };
  for (std::size_t i = 0; i < half; ++i) at(i, 0.2);
  for (std::size_t i = n - half; i-- > 0;) at(i, -0.2);
  std::reverse(corners.begin(), corners.end());
  return corners;
}

/// Long teeth on a back.
std::vector<Vec3d> comb(std::size_t n) {
  std::vector<Vec3d> corners;
  for (std::size_t i = 0; i + 2 < n; ++i)
    corners.emplace_back(static_cast<double>(i), i % 2 == 0 ? 0 : static_cast<double>(n), 0);
  corners.emplace_back(static_cast<double>(n), -1, 0);
  corners.emplace_back(-1, -1, 0);
  return corners;
}

/// Bends a polygon of the plane z = 0 into space, in waves and dents. These are smaller for more
/// corners, so that the polygon stays simple in the projection along its normal.
void bend(std::vector<Vec3d>& corners, std::mt19937& random) {
  double size = 0;
  for (const Vec3d& corner : corners) size = std::max(size, corner.norm());
  const double height = 0.4 * size / static_cast<double>(corners.size());
  std::uniform_real_distribution<double> dent(-height, height);
  for (Vec3d& corner : corners)
    corner.z() = height * std::sin(3 * corner.x() / size) * std::cos(2 * corner.y() / size) +
                 dent(random) / 2;
}

void turnAnyway(std::vector<Vec3d>& corners, std::mt19937& random) {
  std::uniform_real_distribution<double> any(-1, 1);
  const Eigen::Quaterniond turn =
      Eigen::Quaterniond(any(random), any(random), any(random), any(random)).normalized();
  const Vec3d shift(any(random), any(random), any(random));
  for (Vec3d& corner : corners) corner = turn * corner + 10 * shift;
}

void checkSimple(const std::vector<Vec3d>& corners) {
  const auto [triangles, fanned] = triangulated(corners);
  CHECK(fanned == 0);
  CHECK(isDisk(triangles, corners.size()));
  CHECK(coverage(corners, triangles) == Approx(1).epsilon(1e-9));
  Vec3d area = Vec3d::Zero();
  for (const auto& t : triangles) area += areaVector(corners[t[0]], corners[t[1]], corners[t[2]]);
  const Vec3d whole = areaVector(corners);
  CHECK((area - whole).norm() <= 1e-9 * whole.norm());  // and so the winding
}

}  // namespace

TEST_CASE("concave polygons keep area, winding and sides, planar or not",
          "[voxelize][triangulate][property]") {
  const auto n = GENERATE(as<std::size_t>(), 5, 6, 7, 10, 33, 100, 1000, 5000);
  const bool bent = GENERATE(false, true);
  const std::string kind = GENERATE("star", "spiral", "comb", "reversed comb");
  CAPTURE(n, bent, kind);
  if (kind == "spiral" && n < 33) return;
  std::mt19937 random(static_cast<std::uint32_t>(n));
  for (int i = 0; i < (n < 200 ? 10 : 1); ++i) {
    std::vector<Vec3d> corners;
    if (kind == "star") corners = star(n, random);
    if (kind == "spiral") corners = spiral(n);
    if (kind.ends_with("comb")) corners = comb(n);
    if (kind.starts_with("reversed")) std::reverse(corners.begin(), corners.end());
    if (bent) bend(corners, random);
    turnAnyway(corners, random);
    checkSimple(corners);
  }
}

TEST_CASE("a quad splits along its shorter diagonal", "[voxelize][triangulate][golden]") {
  const std::vector<Vec3d> flat = {{0, 0, 0}, {2, -1, 0}, {4, 0, 0}, {2, 1, 0}};
  CHECK(triangulated(flat).triangles == Triangles{{0, 1, 3}, {1, 2, 3}});
  const std::vector<Vec3d> tall = {{0, -1, 0}, {2, 0, 0}, {0, 1, 0}, {-2, 0, 0}};
  CHECK(triangulated(tall).triangles == Triangles{{0, 1, 2}, {0, 2, 3}});
  const std::vector<Vec3d> square = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
  CHECK(triangulated(square).triangles == Triangles{{0, 1, 2}, {0, 2, 3}});
  CHECK(triangulated(square).fanned == 0);
}

TEST_CASE("a concave quad splits along the diagonal that lies inside, though it is longer",
          "[voxelize][triangulate][golden]") {
  std::vector<Vec3d> arrow = {{0, 0, 0}, {1, 1, 0}, {0, 9, 0}, {-1, 1, 0}};
  std::vector<Vec3d> dart = {{0, 1, 0}, {3, 0, 0}, {0, 9, 0}, {-3, 0, 0}};  // concave at corner 0
  CHECK(triangulated(dart).triangles == Triangles{{0, 1, 2}, {0, 2, 3}});
  CHECK(triangulated(dart).fanned == 0);
  std::rotate(dart.begin(), dart.begin() + 1, dart.end());
  CHECK(triangulated(dart).triangles == Triangles{{0, 1, 3}, {1, 2, 3}});
  CHECK(triangulated(arrow).triangles == Triangles{{0, 1, 3}, {1, 2, 3}});
}

TEST_CASE("corners along a side are used without triangles of no area",
          "[voxelize][triangulate][property]") {
  std::vector<Vec3d> corners;
  const std::vector<Vec3d> outline = {{0, 0, 0}, {8, 0, 0}, {8, 8, 0}, {4, 4, 0}, {0, 8, 0}};
  for (std::size_t i = 0; i < outline.size(); ++i)
    for (int k = 0; k < 8; ++k)
      corners.push_back(outline[i] + (outline[(i + 1) % outline.size()] - outline[i]) * k / 8);
  checkSimple(corners);
  for (const auto& t : triangulated(corners).triangles)
    CHECK(areaVector(corners[t[0]], corners[t[1]], corners[t[2]]).norm() > 0.1);
}

TEST_CASE("a hole joined to the outside by a bridge stays open",
          "[voxelize][triangulate][property]") {
  for (const int sides : {4, 7, 40}) {
    CAPTURE(sides);
    std::vector<Vec3d> corners;
    const auto ring = [&](double radius, int direction) {
      for (int i = 0; i <= sides; ++i) {
        const double t = 2 * std::numbers::pi * (direction * i % sides) / sides;
        corners.emplace_back(radius * std::cos(t), radius * std::sin(t), 0);
      }
    };
    ring(2, 1);
    ring(1, -1);
    const auto [triangles, fanned] = triangulated(corners);
    CHECK(fanned == 0);
    CHECK(isDisk(triangles, corners.size()));
    CHECK(coverage(corners, triangles) == Approx(1).epsilon(1e-9));
  }
}

TEST_CASE("ears are clipped all around, not in a fan", "[voxelize][triangulate]") {
  std::vector<Vec3d> corners;
  Triangles fan;
  for (Index i = 0; i < 48; ++i) {
    corners.emplace_back(std::cos(i * std::numbers::pi / 24), std::sin(i * std::numbers::pi / 24),
                         0);
    if (i >= 2) fan.push_back({0, i - 1, i});
  }
  const auto sides = [&](const Triangles& triangles) {
    double length = 0;
    for (const auto& t : triangles)
      for (std::size_t i = 0; i < 3; ++i)
        length += (corners[t[(i + 1) % 3]] - corners[t[i]]).norm();
    return length;
  };
  CHECK(sides(triangulated(corners).triangles) < sides(fan) / 2);
}

TEST_CASE("convex polygons lose the best-shaped ear first, small ones too",
          "[voxelize][triangulate]") {
  std::mt19937 random(11);
  std::uniform_real_distribution<double> any(0, 1);
  for (std::size_t n = 5; n <= 12; ++n)
    for (int repeat = 0; repeat < 50; ++repeat) {
      CAPTURE(n, repeat);
      std::vector<double> angles(n);
      for (double& angle : angles) angle = 2 * std::numbers::pi * any(random);
      std::sort(angles.begin(), angles.end());
      std::vector<Vec3d> corners;
      for (const double t : angles) corners.emplace_back(3 * std::cos(t), std::sin(t), 0);
      turnAnyway(corners, random);

      std::vector<Index> left(n);
      std::iota(left.begin(), left.end(), 0U);
      Triangles expected;
      while (left.size() > 3) {
        const auto ear = [&](std::size_t i) {
          return std::array{left[(i + left.size() - 1) % left.size()], left[i],
                            left[(i + 1) % left.size()]};
        };
        std::size_t best = 0;
        for (std::size_t i = 1; i < left.size(); ++i)
          if (earQuality(corners, ear(i)) > earQuality(corners, ear(best))) best = i;
        expected.push_back(ear(best));
        left.erase(left.begin() + static_cast<std::ptrdiff_t>(best));
      }
      expected.push_back({left[0], left[1], left[2]});
      const Triangulated result = triangulated(corners);
      CHECK(result.triangles == expected);
      CHECK(result.fanned == 0);
    }
}

TEST_CASE("small polygons that wind around twice are cut into disks", "[voxelize][triangulate]") {
  for (const std::size_t n : {5U, 6U, 7U}) {
    CAPTURE(n);
    std::vector<Vec3d> corners;
    for (std::size_t i = 0; i < n; ++i) {
      const double t = 4 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(n);
      const double r = n == 6 && i >= 3 ? 1.1 : 1;
      corners.emplace_back(r * std::cos(t), r * std::sin(t), 0);
    }
    CHECK(isDisk(triangulated(corners).triangles, n));
  }
}

TEST_CASE("a polygon without ears becomes a fan and is counted", "[voxelize][triangulate]") {
  const Vec3d a(0, 0, 0);
  const Vec3d b(1, 0, 0);
  const Vec3d c(0, 1, 0);
  const Vec3d d(1, 1, 0);
  const std::vector<Vec3d> onePoint(7, a);
  const std::vector<Vec3d> onLine = {a, b, 2 * b, 3 * b, 2 * b, b};
  const std::vector<Vec3d> bowTie = {a, b, c, d};
  const std::vector<Vec3d> eight = {a, b, d, 2 * d, 2 * b, c};
  for (const auto& corners : {onePoint, onLine, bowTie, eight}) {
    const auto [triangles, fanned] = triangulated(corners);
    CHECK(triangles.size() == corners.size() - 2);
    for (const auto& t : triangles)
      for (const Index corner : t) CHECK(corner < corners.size());
  }
  CHECK(triangulated(onePoint).fanned == 1);
  CHECK(triangulated(onLine).fanned == 1);
  CHECK(triangulated(bowTie).fanned == 1);
  CHECK(triangulated({a, b, c}).triangles == Triangles{{0, 1, 2}});
  CHECK(triangulated({a, b}).triangles.empty());
  CHECK(triangulated({}).triangles.empty());
}

TEST_CASE("repeated corners and spikes leave the rest as it is", "[voxelize][triangulate]") {
  const std::vector<Vec3d> spiked = {{0, 0, 0}, {4, 0, 0}, {4, 0, 0}, {4, 4, 0},
                                     {4, 6, 0}, {4, 4, 0}, {0, 4, 0}};
  const auto [triangles, fanned] = triangulated(spiked);
  CHECK(triangles.size() == 5);
  CHECK(coverage(spiked, triangles) == Approx(1));
}

TEST_CASE("corners at one place are no folds, and leave the other triangles as they are",
          "[voxelize][triangulate]") {
  const std::vector<Vec3d> triangle = {{0, 0, 0}, {4, 0, 0}, {0, 3, 1}};
  const std::vector<Vec3d> quad = {{0, 0, 0}, {4, 0, 0}, {4, 4, 1}, {0, 4, 0}};
  std::mt19937 random(7);
  for (const auto& corners : {triangle, quad, star(9, random)}) {
    const double covered = coverage(corners, triangulated(corners).triangles);
    for (unsigned which = 1; which < 1U << corners.size(); ++which) {
      std::vector<Vec3d> repeated;
      for (std::size_t i = 0; i < corners.size(); ++i)
        repeated.insert(repeated.end(), 1 + (which >> i & 1U) * (1 + i % 2), corners[i]);
      // The first corner may be at the place of the last.
      std::rotate(repeated.begin(), repeated.begin() + which % 2, repeated.end());
      const auto [triangles, fanned] = triangulated(repeated);
      REQUIRE(fanned == 0);
      REQUIRE(isDisk(triangles, repeated.size()));
      REQUIRE(coverage(repeated, triangles) == Approx(covered));
    }
  }
}
