#include "libvox/mesh/patch.h"

#include "tests/shapes.h"
#include "tests/spline_torus.h"

#include <catch2/catch.hpp>

using namespace vox;

TEST_CASE("points and normals of patches are those of the B-spline", "[normals][golden]") {
  const int major = 9;
  const int minor = 6;
  const test::SplineTorus torus(major, minor);
  const auto controls = test::torusGrid(major, minor).points;
  for (int i = 0; i < major; ++i)
    for (int j = 0; j < minor; ++j) {
      Patch patch;
      for (int a = 0; a < 3; ++a)
        for (int b = 0; b < 3; ++b)
          patch.points[std::size_t(a)][std::size_t(b)] =
              controls[std::size_t((i + a) % major * minor + (j + b) % minor)];
      for (const double u : {0.125, 0.375, 0.5, 0.625, 0.875}) {
        const SplinePoint place = splinePoint(patch.points, {u}, {0.75});
        CHECK((place.point - torus.at(i + u, j + 0.75)).norm() < 1e-13);
        CHECK((place.normal - torus.normalAt(i + u, j + 0.75)).norm() < 1e-13);
      }
    }
}

TEST_CASE("a point without a tangent plane has no normal", "[normals]") {
  Patch patch;
  for (auto& row : patch.points) row.fill(Vec3d(0.1, 0.7, 1e6 / 3));
  CHECK(splinePoint(patch.points, {0.5}, {0.5}).normal.isZero(0));
  for (std::size_t u = 0; u < 3; ++u)
    for (std::size_t v = 0; v < 3; ++v)
      patch.points[u][v] = double(u + v) * Vec3d(0.1, 0.2, 0.3) + Vec3d(1, 2, 5);
  CHECK(splinePoint(patch.points, {0.375}, {0.625}).normal.isZero(0));
}

TEST_CASE("a flat patch goes on straight where faces are missing", "[golden]") {
  const Vec3d x(3, 0, 1);
  const Vec3d y(0, 2, -1);
  Patch flat;
  for (std::size_t u = 0; u < 3; ++u)
    for (std::size_t v = 0; v < 3; ++v)
      flat.points[u][v] = Vec3d(7, 8, 9) + double(u) * x + double(v) * y;
  for (unsigned others = 0; others < 8; ++others) {
    CAPTURE(others);
    const auto has = [&](unsigned quadrants) { return ((others | 8U) & quadrants) != 0; };
    Patch partial = flat;
    partial.quadrants = static_cast<std::uint8_t>(others | 8U);
    const Vec3d unknown = Vec3d::Zero();
    for (unsigned q = 0; q < 4; ++q)
      if (!has(1U << q)) partial.points[q & 2U][2 * (q & 1U)] = unknown;
    if (!has(1U | 2U)) partial.points[0][1] = unknown;
    if (!has(1U | 4U)) partial.points[1][0] = unknown;
    const Patch whole = continued(partial);
    CHECK(whole.quadrants == kAllQuadrants);
    for (std::size_t u = 0; u < 3; ++u)
      for (std::size_t v = 0; v < 3; ++v)
        CHECK((whole.points[u][v] - flat.points[u][v]).norm() < 1e-13);
  }
}
