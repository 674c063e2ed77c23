#include "libvox/render/ray_cast.h"

#include "libvox/core/error.h"

#include <catch2/catch.hpp>
#include <openvdb/tools/LevelSetSphere.h>

#include <random>

using namespace vox;
using openvdb::Coord;

namespace {

/// A cloud of voxels around a corner of nodes of every level, and an active tile of 8^3.
openvdb::MaskTree scattered() {
  openvdb::MaskTree voxels;
  std::mt19937 random(3);
  std::uniform_int_distribution<int> near(-20, 20);
  for (int i = 0; i < 300; ++i) voxels.setValueOn(Coord(near(random), near(random), near(random)));
  voxels.addTile(1, Coord(24, 0, 0), true, true);
  for (int i = 0; i < 20; ++i)
    voxels.setValueOn(Coord(4096 + near(random), near(random), near(random)));
  return voxels;
}

std::vector<Coord> activeOf(const openvdb::MaskTree& voxels) {
  std::vector<Coord> all;
  for (auto value = voxels.cbeginValueOn(); value; ++value) {
    openvdb::CoordBBox box;
    value.getBoundingBox(box);
    for (auto voxel = box.begin(); voxel; ++voxel) all.push_back(*voxel);
  }
  return all;
}

/// Times at which a ray enters and leaves the unit cube around a voxel; the first is larger if it
/// misses the cube.
std::pair<double, double> timesInside(const IndexRay& ray, const Coord& voxel) {
  double from = ray.t0();
  double to = ray.t1();
  for (int axis = 0; axis < 3; ++axis) {
    const double a = (voxel[axis] - 0.5 - ray.eye()[axis]) / ray.dir()[axis];
    const double b = (voxel[axis] + 0.5 - ray.eye()[axis]) / ray.dir()[axis];
    from = std::max(from, std::min(a, b));
    to = std::min(to, std::max(a, b));
  }
  return {from, to};
}

openvdb::Vec3d randomDirection(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return openvdb::Vec3d(normal(random), normal(random), normal(random)).unit();
}

}  // namespace

TEST_CASE("a ray hits the voxel that brute force finds first", "[inspect][property]") {
  const openvdb::MaskTree voxels = scattered();
  const std::vector<Coord> all = activeOf(voxels);
  const auto caster = voxelCaster(voxels);
  std::mt19937 random(11);
  int hits = 0;
  for (int i = 0; i < 2000; ++i) {
    const openvdb::Vec3d from = 60 * randomDirection(random);
    const openvdb::Vec3d to = 15 * randomDirection(random);
    const IndexRay ray(from, (to - from).unit());
    double first = 1e300;
    Coord voxel;
    for (const Coord& candidate : all) {
      const auto [enter, leave] = timesInside(ray, candidate);
      constexpr double kGrazing = 1e-9;  // an edge may be hit or missed
      if (leave - enter < kGrazing || enter >= first) continue;
      first = enter;
      voxel = candidate;
    }
    const auto hit = caster->firstHit(ray);
    REQUIRE(hit.has_value() == (first < 1e300));
    if (!hit) continue;
    ++hits;
    CHECK(hit->voxel == voxel);
    CHECK(hit->time == Approx(first).margin(1e-9));
    // The face that is hit faces the origin of the ray, and the hit point lies on it.
    const openvdb::Vec3d face(hit->face.x(), hit->face.y(), hit->face.z());
    CHECK(face.dot(ray.dir()) < 0);
    CHECK((ray(hit->time) - voxel.asVec3d()).dot(face) == Approx(0.5).margin(1e-9));
  }
  CHECK(hits > 500);
}

TEST_CASE("rays along an axis, and through empty space between far nodes, arrive", "[inspect]") {
  openvdb::MaskTree voxels;
  voxels.setValueOn(Coord(5, 6, 7));
  voxels.setValueOn(Coord(1 << 29, 6, 7));
  const auto caster = voxelCaster(voxels);
  const auto first = caster->firstHit(IndexRay({0, 6, 7}, {1, 0, 0}));
  REQUIRE(first);
  CHECK(first->voxel == Coord(5, 6, 7));
  CHECK(first->time == 4.5);
  CHECK(first->face == Vec3d(-1, 0, 0));
  const auto second = caster->firstHit(IndexRay({6, 6, 7}, {1, 0, 0}));
  REQUIRE(second);
  CHECK(second->voxel == Coord(1 << 29, 6, 7));
  CHECK_FALSE(caster->firstHit(IndexRay({0, 8, 7}, {1, 0, 0})));
  CHECK_FALSE(caster->firstHit(IndexRay({0, 6, 7}, {1, 0, 0}, 1e-9, 4)));
}

TEST_CASE("rays meet the sphere that a level set is of", "[inspect][golden]") {
  constexpr double kRadius = 20;
  constexpr double kVoxel = 0.5;
  const auto sphere = openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(
      float(kRadius * kVoxel), openvdb::Vec3f(0), float(kVoxel));
  const auto caster = levelSetCaster(*sphere);
  std::mt19937 random(5);
  for (int i = 0; i < 500; ++i) {
    const openvdb::Vec3d out = randomDirection(random);
    const auto hit = caster->firstHit(IndexRay(100 * out, -out));
    REQUIRE(hit);
    CHECK(hit->time == Approx(100 - kRadius).margin(0.15));  // linear within a voxel
    CHECK(hit->face.dot(Vec3d(out[0], out[1], out[2])) > 0.998);
    CHECK(hit->voxel == Coord::round((100 - hit->time) * out));
  }
  CHECK_FALSE(caster->firstHit(IndexRay({-100, 21, 0}, {1, 0, 0})));
}

TEST_CASE("a level set without its surface in the narrow band is refused", "[inspect][error]") {
  auto grid = openvdb::FloatGrid::create(0);
  grid->setGridClass(openvdb::GRID_LEVEL_SET);
  grid->tree().setValue(Coord(0, 0, 0), 1);
  CHECK_THROWS_AS(levelSetCaster(*grid), InputError);
}
