// The comparison of level sets with the truth finds each kind of fault, and nothing else.

#include "tests/level_set_errors.h"

#include "libvox/core/parallel.h"
#include "libvox/subdivide/doo_sabin.h"
#include "tests/shapes.h"
#include "tests/spline_torus.h"

#include <catch2/catch.hpp>
#include <openvdb/tools/SignedFloodFill.h>

#include <cmath>
#include <functional>

using namespace vox;
using openvdb::Coord;
using test::compareLevelSet;
using test::LevelSetErrors;

namespace {

constexpr double kBallRadius = 20.255;  // voxels are at sqrt(410), 0.007 inside
constexpr std::size_t kMany = 20000;

class Ball : public test::Surface {
 public:
  Foot of(const Vec3d& p) const override {
    const double side = p.norm() - kBallRadius;
    const Vec3d normal = p.stableNormalized();
    return {std::abs(side), side, kBallRadius * normal, normal, 1};
  }
  Sample sample(std::uint64_t number) const override {
    const Vec3d corner(test::mixedFraction(3 * number) - 0.5,
                       test::mixedFraction(3 * number + 1) - 0.5,
                       test::mixedFraction(3 * number + 2) - 0.5);
    const Vec3d normal = corner.stableNormalized();
    return {kBallRadius * normal, normal};
  }
};

/// A level set by a formula for the distance in voxels.
openvdb::FloatGrid::Ptr levelSetOf(const std::function<double(const Vec3d&)>& distance, int reach,
                                   double voxelSize, double bandIn, double bandOut) {
  const auto grid = openvdb::FloatGrid::create(static_cast<float>(bandOut * voxelSize));
  auto values = grid->getAccessor();
  for (int x = -reach; x <= reach; ++x)
    for (int y = -reach; y <= reach; ++y)
      for (int z = -reach; z <= reach; ++z) {
        const double d = distance({double(x), double(y), double(z)});
        if (-bandIn < d && d < bandOut)
          values.setValue({x, y, z}, static_cast<float>(d * voxelSize));
      }
  openvdb::tools::signedFloodFillWithValues(grid->tree(), static_cast<float>(bandOut * voxelSize),
                                            static_cast<float>(-bandIn * voxelSize));
  return grid;
}

openvdb::FloatGrid::Ptr ballGrid(double radius = kBallRadius) {
  return levelSetOf([=](const Vec3d& p) { return p.norm() - radius; }, 26, 0.5, 2, 4);
}

LevelSetErrors errorsOf(const openvdb::FloatGrid& grid) {
  return compareLevelSet(grid, Ball(), 0.5, 2, 4, kMany);
}

std::size_t faultsOf(const LevelSetErrors& errors) {
  return errors.wrongSigns + errors.surplus + errors.missing + errors.wrongBackgrounds +
         errors.wrongSides;
}

}  // namespace

TEST_CASE("a level set by the formula of the truth has no errors", "[truth]") {
  const LevelSetErrors errors = errorsOf(*ballGrid());
  CHECK(errors.active > kMany / 2);
  CHECK(errors.near > kMany / 2);
  CHECK(errors.inactive > kMany / 2);
  CHECK(errors.largest < 1e-6);  // floats
  CHECK(faultsOf(errors) == 0);
}

TEST_CASE("a ball too small by 0.1 is off by 0.1 everywhere", "[truth]") {
  const LevelSetErrors errors = errorsOf(*ballGrid(kBallRadius - 0.1));
  CHECK(errors.rms == Approx(0.1).margin(0.002));  // near the surface, signs may differ
  CHECK(errors.largest == Approx(0.1).margin(1e-5));
  CHECK(errors.wrongSigns > 0);
  CHECK(errors.surplus > 0);
  CHECK(errors.missing > 0);
  CHECK(errorsOf(*ballGrid(kBallRadius - 0.015)).wrongSigns == 0);  // too close to the surface
}

TEST_CASE("every kind of fault of a level set is found", "[truth]") {
  const auto grid = ballGrid();
  for (auto value = grid->beginValueOn(); value; ++value) {
    const Coord voxel = value.getCoord();
    if (voxel.x() > 12) value.setValue(-*value);         // wrong signs
    if (voxel.y() > 12) value.setValueOff();             // missing; no background
    if (voxel.z() > 12) value.setValue(*value + 0.15F);  // 0.3 voxels
  }
  auto values = grid->getAccessor();
  for (int x = -10; x <= 10; ++x)
    for (int y = -10; y <= 10; ++y) values.setValue({x, y, 0}, 0);  // surplus

  const LevelSetErrors errors = errorsOf(*grid);
  CHECK(errors.wrongSigns > 100);
  CHECK(errors.missing > 100);
  CHECK(errors.wrongBackgrounds > 100);
  CHECK(errors.surplus > 100);
  CHECK(errors.rms > 0.05);

  const auto inverted = ballGrid();
  for (auto value = inverted->beginValueOff(); value; ++value) value.setValue(-*value);
  CHECK(errorsOf(*inverted).wrongSides > 1000);

  const auto hollow = ballGrid();
  for (auto value = hollow->beginValueOff(); value; ++value) value.setValue(2);  // far inside, too
  const LevelSetErrors sides = errorsOf(*hollow);
  CHECK(sides.wrongSides > 100);
  CHECK(sides.wrongBackgrounds == 0);
}

TEST_CASE("values are compared in any order of threads and samples", "[truth][parallel]") {
  const auto grid = ballGrid(kBallRadius - 0.1);
  const LevelSetErrors a = errorsOf(*grid);
  const LevelSetErrors b = onThreads(8, [&] { return errorsOf(*grid); });
  CHECK(a.rms == b.rms);
  CHECK(a.near == b.near);
  CHECK(a.wrongSigns == b.wrongSigns);
  const LevelSetErrors few = compareLevelSet(*grid, Ball(), 0.5, 2, 4, 1000);
  CHECK(few.active == Approx(1000).epsilon(0.2));
}

TEST_CASE("two truths of a torus agree", "[truth]") {
  constexpr double kScale = 6;
  const test::SplineTorus torus(12, 8);
  const auto grid =
      levelSetOf([&](const Vec3d& p) { return kScale * torus.distance(p / kScale); }, 12, 1, 3, 3);
  const test::ClosestPoint truth(baseLevel(test::scaled(test::torusGrid(12, 8), kScale)), 3);
  const LevelSetErrors errors = compareLevelSet(*grid, truth, 1, 3, 3, 5000);
  CHECK(errors.active > 2000);
  CHECK(errors.largest < 1e-5);  // floats
  CHECK(faultsOf(errors) == 0);
}
