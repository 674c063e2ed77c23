#include "libvox/render/visible.h"

#include "libvox/core/error.h"

#include <catch2/catch.hpp>
#include <openvdb/tools/LevelSetSphere.h>

#include <limits>

using namespace vox;
using Catch::Contains;
using openvdb::Coord;

namespace {

template <class GridT>
typename GridT::Ptr gridOf(const std::string& name, const typename GridT::ValueType& value) {
  auto grid = GridT::create();
  grid->setName(name);
  grid->tree().setValueOn(Coord(1, 2, 3), value);
  return grid;
}

openvdb::GridBase::Ptr maskOf(const std::string& name) {
  auto grid = openvdb::MaskGrid::create();
  grid->setName(name);
  grid->tree().setValueOn(Coord(1, 2, 3));
  return grid;
}

std::vector<openvdb::GridBase::Ptr> listOf(std::vector<openvdb::GridBase::Ptr> grids) {
  return grids;
}

}  // namespace

TEST_CASE("of several grids, the most informative one is shown", "[inspect]") {
  const auto fog = gridOf<openvdb::FloatGrid>("other", 2);
  const auto density = gridOf<openvdb::FloatGrid>("density", 1);
  density->tree().setValueOn(Coord(9, 9, 9), 1);
  const auto surface = openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(5, {0, 0, 0}, 1);
  surface->setName("surface");
  const auto empty = openvdb::MaskGrid::create();
  empty->setName("mask");
  CHECK(visibleGrids(listOf({fog, density, surface, empty}), {}).voxels->activeVoxelCount() == 2);
  CHECK(visibleGrids(listOf({fog, maskOf("mask"), density}), {}).voxels->activeVoxelCount() == 1);
  CHECK(visibleGrids(listOf({fog, surface}), {}).levelSet == surface);
  CHECK(visibleGrids(listOf({density, surface}), {"surface", {}}).levelSet == surface);
  CHECK(visibleGrids(listOf({gridOf<openvdb::Vec3SGrid>("v", {1, 0, 0}), fog}), {}).voxels);
}

TEST_CASE("fog is solid above the threshold, tiles and NaN included", "[inspect]") {
  const auto fog = openvdb::FloatGrid::create();
  fog->tree().setValueOn(Coord(0, 0, 0), 10);
  fog->tree().setValueOn(Coord(1, 0, 0), 1.01F);
  fog->tree().setValueOn(Coord(2, 0, 0), 1);
  fog->tree().setValueOn(Coord(3, 0, 0), -1);
  fog->tree().setValueOn(Coord(4, 0, 0), std::numeric_limits<float>::quiet_NaN());
  fog->tree().setValueOff(Coord(5, 0, 0), 10);
  fog->tree().addTile(1, Coord(64, 0, 0), 5, true);
  fog->tree().addTile(1, Coord(72, 0, 0), 0.5, true);
  const auto count = [&](std::optional<double> threshold) {
    return visibleGrids(listOf({fog}), {"", threshold}).voxels->activeVoxelCount();
  };
  CHECK(count({}) == 2 + 512);  // the largest value is 10
  CHECK(count(0.7) == 3 + 512);
  CHECK(count(0.1) == 3 + 1024);
  CHECK(count(5) == 1);
  CHECK_THROWS_WITH(count(10), Contains("threshold"));
  const auto flags = gridOf<openvdb::BoolGrid>("flags", true);
  flags->tree().setValueOn(Coord(0, 0, 0), false);
  CHECK(visibleGrids(listOf({flags}), {}).voxels->activeVoxelCount() == 1);
}

TEST_CASE("normals and colours are found by either name where they lie alike", "[inspect]") {
  const auto mask = maskOf("mask");
  const auto normals = gridOf<openvdb::Vec3SGrid>("N", {0, 0, 1});
  const auto colors = gridOf<openvdb::Vec3SGrid>("color", {1, 0, 0});
  const VisibleGrids visible = visibleGrids(listOf({mask, normals, colors}), {});
  CHECK(visible.normals == normals);
  CHECK(visible.colors == colors);
  normals->setTransform(openvdb::math::Transform::createLinearTransform(2));
  CHECK_FALSE(visibleGrids(listOf({mask, normals}), {}).normals);
}

TEST_CASE("grids that cannot be shown are refused by name", "[inspect][error]") {
  const auto look = [](std::vector<openvdb::GridBase::Ptr> grids, const std::string& name = "") {
    return visibleGrids(grids, {name, {}});
  };
  CHECK_THROWS_WITH(look({}), Contains("no grid"));
  CHECK_THROWS_WITH(look({maskOf("mask")}, "fog"), Contains("no grid fog") && Contains("mask"));
  const auto vectors = gridOf<openvdb::Vec3SGrid>("v", {1, 0, 0});
  CHECK_THROWS_WITH(look({vectors}, "v"), Contains("grid v") && Contains("vec3s"));
  CHECK_THROWS_WITH(look({vectors}), Contains("there are v"));
  const auto empty = openvdb::FloatGrid::create();
  empty->setName("empty");
  CHECK_THROWS_WITH(look({empty}, "empty"), Contains("empty"));

  const auto uneven = openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(5, {0, 0, 0}, 1);
  uneven->setName("uneven");
  uneven->transform().preScale(openvdb::Vec3d(1, 2, 1));
  CHECK_THROWS_WITH(look({uneven}), Contains("uneven") && Contains("cubes"));

  const auto frustum = maskOf("frustum");
  frustum->setTransform(openvdb::math::Transform::createFrustumTransform(
      openvdb::BBoxd({0, 0, 0}, {9, 9, 9}), 0.5, 1));
  CHECK_THROWS_WITH(look({frustum}), Contains("frustum"));

  const auto far = openvdb::MaskGrid::create();
  far->tree().setValueOn(Coord(0, (1 << 30) + 1, 0));
  CHECK_THROWS_AS(look({far}), LimitError);
}
