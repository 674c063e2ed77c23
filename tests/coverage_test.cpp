#include "libvox/volume/coverage.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

using namespace vox;

namespace {

/// The part of a cube on the inner side, by columns: exact along z, by the midpoint rule across.
double coverageByColumns(double distance, Vec3d normal) {
  normal = normal.cwiseAbs();
  std::sort(normal.begin(), normal.end());
  constexpr int kColumns = 400;
  double sum = 0;
  for (int i = 0; i < kColumns; ++i)
    for (int j = 0; j < kColumns; ++j) {
      const double x = (i + 0.5) / kColumns - 0.5;
      const double y = (j + 0.5) / kColumns - 0.5;
      const double top = -(distance + normal[0] * x + normal[1] * y) / normal[2];
      sum += std::clamp(top + 0.5, 0.0, 1.0);
    }
  return sum / kColumns / kColumns;
}

std::vector<Vec3d> normals() {
  std::vector<Vec3d> all = {{1, 0, 0},       {0, -1, 0},       {1, 1, 0},         {0, 1, -1},
                            {1, 1, 1},       {1, 2, 3},        {1e-4, 1, 1},      {1e-6, 1e-6, 1},
                            {1e-5, 1e-3, 1}, {1e-9, 0.3, 0.9}, {-1e-300, 1, 1e-7}};
  std::mt19937 random(5);
  std::normal_distribution<double> component;
  for (int i = 0; i < 40; ++i)
    all.emplace_back(component(random), component(random), component(random));
  for (Vec3d& n : all) n.normalize();
  return all;
}

}  // namespace

TEST_CASE("coverage is the volume below a plane", "[coverage][property]") {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> anyDistance(-1, 1);
  for (const Vec3d& n : normals())
    for (int i = 0; i < 6; ++i) {
      const double t = anyDistance(random);
      CAPTURE(t, n.transpose());
      // The midpoint rule errs by about (1 / 400)^2.
      CHECK(coverage(t, n) == Approx(coverageByColumns(t, n)).margin(2e-5));
    }
}

TEST_CASE("coverage of the planes that have simple ones", "[coverage][golden]") {
  const Vec3d diagonal = Vec3d(1, 1, 1).normalized();
  const Vec3d edge = Vec3d(1, 0, -1).normalized();
  for (const Vec3d& n : normals()) {
    CHECK(coverage(0, n) == Approx(0.5).margin(1e-12));
    CHECK(coverage(0.9, n) == 0);
    CHECK(coverage(-0.9, n) == 1);
  }
  for (const double t : {0.0, 0.1, -0.3, 0.49})
    CHECK(coverage(t, {0, 0, 1}) == Approx(0.5 - t).margin(1e-15));
  // A corner that ends halfway along its three edges, a prism that ends halfway along two.
  CHECK(coverage(1 / std::sqrt(3.0), diagonal) == Approx(1.0 / 48).epsilon(1e-12));
  CHECK(coverage(-1 / std::sqrt(3.0), diagonal) == Approx(47.0 / 48).epsilon(1e-12));
  CHECK(coverage(std::sqrt(0.5) / 2, edge) == Approx(1.0 / 8).epsilon(1e-12));
}

TEST_CASE("what one side of a plane lacks, the other has", "[coverage][property]") {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> anyDistance(-1, 1);
  for (const Vec3d& n : normals())
    for (int i = 0; i < 20; ++i) {
      const double t = anyDistance(random);
      CAPTURE(t, n.transpose());
      CHECK(coverage(t, n) + coverage(-t, n) == Approx(1).margin(1e-15));
      CHECK(coverage(t, n) == coverage(t, -n));
      CHECK(coverage(t, n) == coverage(t, {n[2], n[0], -n[1]}));
      CHECK(coverage(t, n) >= coverage(t + 1e-3, n));
      // Smooth in both arguments, also where the formula changes.
      CHECK(coverage(t + 1e-9, n) == Approx(coverage(t, n)).margin(3e-9));
    }
}

TEST_CASE("a shell is one voxel thick", "[coverage][property]") {
  for (const Vec3d& n : normals()) {
    CAPTURE(n.transpose());
    constexpr double kStep = 1.0 / 512;
    double sum = 0;
    for (double t = -2; t <= 2; t += kStep) sum += shellCoverage(t, n) * kStep;
    CHECK(sum == Approx(1).epsilon(1e-4));
    CHECK(shellCoverage(0.3, n) == Approx(shellCoverage(-0.3, n)).margin(1e-15));
    CHECK(shellCoverage(1.4, n) == 0);
  }
  CHECK(shellCoverage(0.25, {1, 0, 0}) == Approx(0.75));
  CHECK(shellCoverage(0, {0, 1, 0}) == Approx(1));
}
