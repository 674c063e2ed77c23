#include "libvox/render/camera.h"

#include "libvox/core/error.h"

#include <Eigen/LU>
#include <catch2/catch.hpp>

#include <random>

using namespace vox;
using Catch::Contains;

namespace {

std::vector<Vec3d> cloud() {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> at(-1, 1);
  std::vector<Vec3d> points;
  for (int i = 0; i < 50; ++i) points.emplace_back(5 + 3 * at(random), at(random), 2 * at(random));
  return points;
}

/// Position of a point in the picture of a camera: x and y from 0 to 1. It is found by search,
/// because a camera only gives the line of sight through a position of the picture.
Vec3d whereSeen(const Camera& camera, const Vec3d& point) {
  const Sight middle = camera.through(0.5, 0.5);
  const Vec3d toPoint = point - middle.origin;
  const double depth = toPoint.dot(camera.axes.forward);
  // Two corners at that depth span the picture.
  const auto at = [&](double x, double y) {
    const Sight sight = camera.through(x, y);
    const double start = (sight.origin - middle.origin).dot(camera.axes.forward);
    return Vec3d(sight.origin +
                 (depth - start) / sight.direction.dot(camera.axes.forward) * sight.direction);
  };
  const Vec3d corner = at(0, 0);
  const Vec3d right = at(1, 0) - corner;
  const Vec3d down = at(0, 1) - corner;
  return {(point - corner).dot(right) / right.squaredNorm(),
          (point - corner).dot(down) / down.squaredNorm(), depth};
}

}  // namespace

TEST_CASE("views look along the axes that their names say", "[inspect][golden]") {
  const auto forward = [](const char* name, UpAxis up) {
    return axesOf(*viewNamed(name), up).forward;
  };
  CHECK(forward("front", UpAxis::kZ) == Vec3d(0, 1, 0));
  CHECK(forward("back", UpAxis::kZ) == Vec3d(0, -1, 0));
  CHECK(forward("right", UpAxis::kZ) == Vec3d(-1, 0, 0));
  CHECK(forward("left", UpAxis::kZ) == Vec3d(1, 0, 0));
  CHECK(forward("top", UpAxis::kZ) == Vec3d(0, 0, -1));
  CHECK(forward("bottom", UpAxis::kZ) == Vec3d(0, 0, 1));
  CHECK(forward("front", UpAxis::kY) == Vec3d(0, 0, -1));
  CHECK(forward("right", UpAxis::kY) == Vec3d(-1, 0, 0));
  CHECK(forward("top", UpAxis::kY) == Vec3d(0, -1, 0));
  CHECK(axesOf(*viewNamed("front"), UpAxis::kZ).right == Vec3d(1, 0, 0));
  CHECK(axesOf(*viewNamed("front"), UpAxis::kY).up == Vec3d(0, 1, 0));
  const Vec3d diagonal = forward("iso", UpAxis::kZ);
  CHECK((diagonal - Vec3d(-1, 1, -1).normalized()).norm() < 1e-12);
}

TEST_CASE("the axes of any view are a right-handed frame", "[inspect][property]") {
  const double azimuth = GENERATE(-720.0, -33.0, 0.0, 90.0, 123.4, 450.0);
  const double elevation = GENERATE(-90.0, -10.0, 0.0, 60.0, 90.0);
  const UpAxis up = GENERATE(UpAxis::kY, UpAxis::kZ);
  CAPTURE(azimuth, elevation);
  const ViewAxes axes = axesOf({azimuth, elevation}, up);
  Eigen::Matrix3d frame;
  frame << axes.right, axes.up, -axes.forward;
  CHECK((frame.transpose() * frame - Eigen::Matrix3d::Identity()).norm() < 1e-12);
  CHECK(frame.determinant() == Approx(1));
}

TEST_CASE("lists of views mix names and angles", "[inspect][golden]") {
  CHECK(parseViews("front,30,-15.5,top") == std::vector<View>{{0, 0}, {30, -15.5}, {0, 90}});
  for (const char* wrong :
       {"", "fornt", "30", "30,", "30,top", "30,91", "nan,0", "1e999,0", "3x,0"})
    CHECK_THROWS_AS(parseViews(wrong), UsageError);
  CHECK_THROWS_WITH(parseViews("fornt"), Contains("front, back") && Contains("fornt"));
}

TEST_CASE("a framed model fills the picture up to its margin, in the middle",
          "[inspect][property]") {
  const Projection projection = GENERATE(Projection::kOrthographic, Projection::kPerspective);
  const double aspect = GENERATE(0.5, 1.0, 3.0);
  const View view = GENERATE(View{0, 0}, View{77, 20}, View{200, -90});
  CAPTURE(nameIn(kProjectionNames, projection), aspect, view.azimuth);
  Framing framing(view, UpAxis::kZ, projection, aspect);
  for (const Vec3d& point : cloud()) framing.add(point);
  const Camera camera = framing.camera();
  Vec3d low = Vec3d::Constant(1e9);
  Vec3d high = Vec3d::Constant(-1e9);
  for (const Vec3d& point : cloud()) {
    low = low.cwiseMin(whereSeen(camera, point));
    high = high.cwiseMax(whereSeen(camera, point));
    CHECK(camera.place(point)[0] == Approx(whereSeen(camera, point).x()));
    CHECK(camera.place(point)[1] == Approx(whereSeen(camera, point).y()));
  }
  constexpr double kMargin = 0.04;
  CHECK(low.z() > 0);
  for (const int axis : {0, 1}) {
    CHECK(low[axis] >= kMargin - 1e-9);
    CHECK(high[axis] <= 1 - kMargin + 1e-9);
  }
  CHECK(std::min(low.x(), low.y()) == Approx(kMargin));
  CHECK(std::max(high.x(), high.y()) == Approx(1 - kMargin));
}
