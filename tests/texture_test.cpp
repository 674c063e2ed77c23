#include "libvox/volume/texture.h"

#include "libvox/volume/noise.h"
#include "libvox/volume/patterns.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <random>
#include <set>

using namespace vox;

namespace {

Vec3d randomPoint(std::mt19937& random, double size) {
  std::uniform_real_distribution<double> coordinate(-size, size);
  return {coordinate(random), coordinate(random), coordinate(random)};
}

Box unitBox() {
  Box box;
  box.add(Vec3d(0, 0, 0));
  box.add(Vec3d(1, 1, 1));
  return box;
}

}  // namespace

TEST_CASE("noise is 0 at the lattice and within -1 and 1 between", "[texture][property]") {
  std::mt19937 random(1);
  double sum = 0;
  double squares = 0;
  constexpr int kPoints = 20000;
  for (int n = 0; n < kPoints; ++n) {
    const Vec3d p = randomPoint(random, 100);
    const Vec3d lattice = p.array().floor();
    CHECK(gradientNoise(lattice, 5) == 0);
    const double value = gradientNoise(p, 5);
    CHECK(std::abs(value) <= 1);
    sum += value;
    squares += value * value;
  }
  // The mean is 0, the variance is not; standard errors are below 0.003.
  CHECK(std::abs(sum / kPoints) < 0.015);
  CHECK(squares / kPoints > 0.03);
}

TEST_CASE("noise and its slope go on across the lattice", "[texture][property]") {
  std::mt19937 random(2);
  constexpr double kStep = 1e-5;
  for (int n = 0; n < 1000; ++n) {
    Vec3d p = randomPoint(random, 50);
    const int axis = n % 3;
    p[axis] = std::floor(p[axis]);
    const Vec3d step = kStep * Vec3d::Unit(axis);
    const double before = gradientNoise(p - step, 9);
    const double at = gradientNoise(p, 9);
    const double after = gradientNoise(p + step, 9);
    // Second differences are at most the second derivative, below 100, times the step squared.
    CHECK(std::abs(after - 2 * at + before) < 100 * kStep * kStep);
  }
}

TEST_CASE("seeds and cells make different noise", "[texture]") {
  const Vec3d p(0.3, 0.6, 0.2);
  std::set<double> values;
  for (std::uint32_t seed = 0; seed < 8; ++seed)
    for (int cell = 0; cell < 8; ++cell) values.insert(gradientNoise(p + Vec3d(cell, 0, 0), seed));
  CHECK(values.size() > 40);  // of 64, from some hundreds of combinations of gradients
}

TEST_CASE("octaves add detail of half the size and half the height", "[texture]") {
  const Vec3d p(0.3, 0.6, 0.2);
  const double expected = (gradientNoise(p, 3) + gradientNoise(2 * p, 4) / 2) / 1.5;
  CHECK(fractalNoise(p, 2, 3) == Approx(expected));
  CHECK(fractalNoise(p, 1, 3) == gradientNoise(p, 3));
}

TEST_CASE("cells of a checker differ from all their neighbours", "[texture][property]") {
  std::mt19937 random(3);
  for (int n = 0; n < 1000; ++n) {
    const Vec3d p = randomPoint(random, 40);
    for (const std::size_t colors : {2, 3, 5})
      for (int axis = 0; axis < 3; ++axis) {
        const std::size_t here = checkerAt(p, colors);
        CHECK(here < colors);
        CHECK(checkerAt(p + Vec3d::Unit(axis), colors) == (here + 1) % colors);
      }
  }
}

TEST_CASE("rings and veins repeat at unit distance and are continuous", "[texture][property]") {
  for (int n = -40; n < 40; ++n) {
    const double x = n / 8.0;
    CHECK(ringAt(x) == ringAt(x + 1));
    CHECK(veinAt(x) == veinAt(x + 1));
    for (const auto pattern : {ringAt, veinAt}) {
      CHECK((pattern(x) >= 0 && pattern(x) <= 1));
      CHECK(std::abs(pattern(x - 1e-9) - pattern(x + 1e-9)) < 1e-7);
    }
  }
  CHECK(veinAt(3) == 0);
  CHECK(veinAt(3.5) == 1);
  CHECK(ringAt(2) == 0);
}

TEST_CASE("the share of mortar in a wall is that of its joints", "[texture][property]") {
  // Joints of thickness m heights of 1/3 on all sides of bricks 1 x 1/2 x 1/3.
  const double m = 0.3;
  const double brick = (1 - m / 3) * (1 - m * 2 / 3) * (1 - m);
  std::mt19937 random(4);
  constexpr int kPoints = 100000;
  int bricks = 0;
  for (int n = 0; n < kPoints; ++n) bricks += !brickAt(randomPoint(random, 30), m, 0).mortar;
  CHECK(bricks == Approx(brick * kPoints).epsilon(0.02));  // four standard errors
}

TEST_CASE("a brick is one brick, and its neighbours are others", "[texture]") {
  const Vec3d middle(0.5, 0.25, 1.0 / 6);
  const auto hash = brickAt(middle, 0.1, 0).hash;
  for (const Vec3d& step : {Vec3d(0.4, 0, 0), Vec3d(0, -0.2, 0), Vec3d(0, 0, 0.1)}) {
    CHECK(brickAt(middle + step, 0.1, 0).hash == hash);
    CHECK(brickAt(middle + 2 * step, 0.1, 0).hash != hash);
  }
}

TEST_CASE("a gradient runs from the first to the last colour over the object", "[texture]") {
  Box box = unitBox();
  box.add(Vec3d(0, 0, 5));
  const SolidTexture texture(parseTexture("gradient:colors=1:0:0/0:1:0/0:0:1"), box);
  CHECK(texture.colorAt(Vec3d(9, 9, 0)) == Vec3d(1, 0, 0));
  CHECK(texture.colorAt(Vec3d(9, 9, -4)) == Vec3d(1, 0, 0));
  CHECK(texture.colorAt(Vec3d(0, 0, 2.5)) == Vec3d(0, 1, 0));
  CHECK(texture.colorAt(Vec3d(0, 0, 1.25)) == Vec3d(0.5, 0.5, 0));
  CHECK(texture.colorAt(Vec3d(0, 0, 7)) == Vec3d(0, 0, 1));
  const SolidTexture said(parseTexture("gradient:from=1,to=0,axis=2:0:0"), box);
  CHECK(said.colorAt(Vec3d(1, 0, 0)) == parseTexture("gradient").colors.front());
  CHECK(said.colorAt(Vec3d(0, 0, 0)) == parseTexture("gradient").colors.back());
}

TEST_CASE("scale is the size of the pattern, by default an eighth of the longest side",
          "[texture]") {
  const SolidTexture said(parseTexture("stripes:scale=3,axis=x"), unitBox());
  CHECK(said.colorAt(Vec3d(2.9, 0, 0)) == said.colorAt(Vec3d(0.1, 0, 0)));
  CHECK(said.colorAt(Vec3d(3.1, 0, 0)) != said.colorAt(Vec3d(0.1, 0, 0)));
  const SolidTexture unsaid(parseTexture("stripes:axis=x"), unitBox());
  CHECK(unsaid.colorAt(Vec3d(0.124, 0, 0)) == unsaid.colorAt(Vec3d(0.001, 0, 0)));
  CHECK(unsaid.colorAt(Vec3d(0.126, 0, 0)) != unsaid.colorAt(Vec3d(0.001, 0, 0)));
}

TEST_CASE("colours lie within 0 and 1 at any position", "[texture][property]") {
  std::mt19937 random(6);
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const auto* kind :
       {"checker", "stripes:turbulence=2", "rings", "marble", "noise", "gradient", "brick",
        "marble:scale=1e-30", "brick:scale=1e-30,mortar=0"}) {
    CAPTURE(kind);
    const SolidTexture texture(parseTexture(kind), unitBox());
    for (const double size : {1.0, 1e6, 1e15, 1e300, kInfinity}) {
      const Vec3d p =
          std::isfinite(size) ? randomPoint(random, size) : Vec3d(size, 0, std::nan(""));
      const Vec3d color = texture.colorAt(p);
      CHECK((color.minCoeff() >= 0 && color.maxCoeff() <= 1));
    }
  }
}
