#include "libvox/inspect/lint.h"

#include "libvox/core/parallel.h"
#include "libvox/grid/openvdb.h"
#include "libvox/inspect/steep_pairs.h"
#include "libvox/pipeline/convert.h"
#include "tests/shapes.h"
#include "tests/temporary_folder.h"

#include <catch2/catch.hpp>
#include <openvdb/tools/ChangeBackground.h>
#include <openvdb/tools/Diagnostics.h>
#include <openvdb/tools/LevelSetSphere.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

using namespace vox;
using openvdb::Coord;
using openvdb::CoordBBox;

namespace {

std::string codesOf(const std::vector<LintFinding>& findings) {
  std::set<std::string> codes;
  for (const LintFinding& finding : findings) {
    const auto& rules = lintRules();
    CHECK(std::any_of(rules.begin(), rules.end(),
                      [&](const LintRule& rule) { return rule.code == finding.code; }));
    codes.insert(finding.code);
  }
  std::string text;
  for (const std::string& code : codes) text += (text.empty() ? "" : " ") + code;
  return text;
}

openvdb::FloatGrid::Ptr fog(const std::string& name = "density") {
  openvdb::initialize();
  auto grid = openvdb::FloatGrid::create();
  grid->setName(name);
  grid->setGridClass(openvdb::GRID_FOG_VOLUME);
  for (int x = 0; x < 100; ++x) grid->tree().setValueOn({x, 3, 4}, 1.0F);
  return grid;
}

std::string codesOfFile(const openvdb::GridPtrVec& grids, const std::string& creator = "") {
  const test::TemporaryFolder folder;
  openvdb::MetaMap metadata;
  if (!creator.empty()) metadata.insertMeta("creator", openvdb::StringMetadata(creator));
  openvdb::io::File((folder / "a.vdb").string()).write(grids, metadata);
  return codesOf(lintVdb(folder / "a.vdb"));
}

}  // namespace

TEST_CASE("grids made by vox convert have no faults", "[inspect][lint]") {
  const test::TemporaryFolder folder;
  Scene scene;
  scene.objects.push_back({"torus", test::torusGrid(8, 5)});
  ConvertOptions options;
  options.dim = 40;
  options.grids = std::vector{GridKind::kDensity, GridKind::kMask};
  writeGrids(folder / "a.vdb", convert(scene, options), false);
  CHECK(codesOf(lintVdb(folder / "a.vdb")).empty());
  options.grids = std::vector{GridKind::kMask};
  writeGrids(folder / "b.vdb", convert(scene, options), false);
  CHECK(codesOf(lintVdb(folder / "b.vdb")) == "no-density");
}

TEST_CASE("every fault planted in a fog volume is named", "[inspect][lint]") {
  CHECK(codesOf(lintGrid(*fog())).empty());
  const float inf = std::numeric_limits<float>::infinity();
  const auto planted = [](auto&& plant) {
    auto grid = fog();
    plant(*grid);
    return codesOf(lintGrid(*grid));
  };
  using Grid = openvdb::FloatGrid;
  for (const float wrong : {inf, -inf, std::numeric_limits<float>::quiet_NaN()}) {
    CHECK(planted([&](Grid& grid) { grid.tree().setValueOn({50, 3, 4}, wrong); }) == "not-finite");
    CHECK(planted([&](Grid& grid) { grid.tree().setValueOff({70, 3, 5}, wrong); }) == "not-finite");
    CHECK(planted([&](Grid& grid) {
            grid.fill(CoordBBox::createCube({128, 128, 128}, 128), wrong);
          }) == "not-finite");
  }
  CHECK(planted([](Grid& grid) { openvdb::tools::changeBackground(grid.tree(), 0.5F); }) ==
        "background");
  CHECK(planted([](Grid& grid) { grid.clear(); }) == "empty");
  CHECK(planted([](Grid& grid) {
          grid.clear();
          grid.fill(CoordBBox::createCube({0, 0, 0}, 8), 1.0F);
        }) == "tiles-only");
  CHECK(planted([](Grid& grid) {
          for (auto value = grid.beginValueOn(); value; ++value) value.setValue(0.001F);
        }) == "invisible");
  CHECK(planted([](Grid& grid) { grid.setName(""); }) == "name");
  CHECK(planted([](Grid& grid) { grid.setName("my grid"); }) == "name");
  CHECK(planted([](Grid& grid) {
          grid.setTransform(openvdb::math::Transform::createFrustumTransform(
              openvdb::BBoxd({0, 0, 0}, {100, 100, 100}), 0.5, 10.0));
        }) == "frustum");
}

TEST_CASE("a mask that was changed after it was made is recognised", "[inspect][lint]") {
  openvdb::initialize();
  auto mask = openvdb::MaskGrid::create();
  mask->setName("mask");
  for (int x = 0; x < 100; ++x) mask->tree().setValueOn({x, 3, 4});
  mask->insertMeta("vox_active_voxels", openvdb::Int64Metadata(100));
  CHECK(codesOf(lintGrid(*mask)).empty());
  mask->tree().setValueOff({50, 3, 4});
  CHECK(codesOf(lintGrid(*mask)) == "count");
}

TEST_CASE("signed distances are checked as such, and must not be called density",
          "[inspect][lint]") {
  openvdb::initialize();
  const auto sphere = openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(10, {}, 1);
  sphere->setName("surface");
  CHECK(codesOf(lintGrid(*sphere)).empty());
  auto wrong = sphere->deepCopy();
  wrong->setName("density");
  CHECK(codesOf(lintGrid(*wrong)) == "sdf-as-fog");
  wrong->setGridClass(openvdb::GRID_FOG_VOLUME);
  CHECK(codesOf(lintGrid(*wrong)) == "background sdf-as-fog");
  wrong = sphere->deepCopy();
  wrong->tree().setValueOn({10, 0, 0}, 2.5F);  // a slope of more than one
  const auto findings = lintGrid(*wrong);
  CHECK(codesOf(findings) == "level-set");
  CHECK_THAT(findings[0].message,
             Catch::Contains("pairs of neighbouring voxels differ by more than their distance, the "
                             "first at (9 0 0)"));
}

TEST_CASE("a level set with hardly any inside gives a warning", "[inspect][lint]") {
  openvdb::initialize();
  auto grid = openvdb::FloatGrid::create(3);
  grid->setName("surface");
  grid->setGridClass(openvdb::GRID_LEVEL_SET);
  for (int z = -2; z <= 2; ++z)
    for (int x = 0; x < 20; ++x)
      for (int y = 0; y < 20; ++y)
        grid->tree().setValueOn({x, y, z}, static_cast<float>(std::abs(z)) + 0.25F);
  const auto findings = lintGrid(*grid);
  CHECK(codesOf(findings) == "no-inside");
  CHECK_FALSE(findings[0].isFault);
  grid->tree().setValueOn({5, 5, 0}, -0.5F);
  CHECK(codesOf(lintGrid(*grid)).find("no-inside") == std::string::npos);
}

TEST_CASE("a grid longer than EEVEE shows gives a warning, but not for Houdini",
          "[inspect][lint]") {
  const int axis = GENERATE(0, 1, 2);
  const auto grid = fog();
  Coord far(0, 3, 4);
  far[axis] += 2047;
  grid->tree().setValueOn(far, 1.0F);
  CHECK(codesOf(lintGrid(*grid)).empty());
  ++far[axis];
  grid->tree().setValueOn(far, 1.0F);
  const auto findings = lintGrid(*grid);
  CHECK(codesOf(findings) == "eevee");
  CHECK_FALSE(findings[0].isFault);
  grid->insertMeta("vox_options", openvdb::StringMetadata("target=houdini"));
  CHECK(codesOf(lintGrid(*grid)).empty());
}

TEST_CASE("exact distances are no fault where two parts of a surface are equally near",
          "[inspect][lint]") {
  // Half way between two parallel planes the gradient is 0; in the corner between three planes it
  // is sqrt(3) by one-sided differences.
  openvdb::initialize();
  const bool corner = GENERATE(false, true);
  CAPTURE(corner);
  auto grid = openvdb::FloatGrid::create(3);
  grid->setName("surface");
  grid->setGridClass(openvdb::GRID_LEVEL_SET);
  for (int x = -4; x <= 4; ++x)
    for (int y = -4; y <= 4; ++y)
      for (int z = -4; z <= 4; ++z) {
        const int d = corner ? std::max({x, y, z}) : 2 - std::abs(z);
        const auto distance = static_cast<float>(d);
        if (std::abs(d) < 3)
          grid->tree().setValueOn({x, y, z}, distance);
        else
          grid->tree().setValueOff({x, y, z}, std::copysign(3.0F, distance));
      }
  CHECK(codesOf(lintGrid(*grid)).empty());
  CHECK(!openvdb::tools::checkLevelSet(*grid).empty());
}

TEMPLATE_TEST_CASE("pairs of voxels that no distances allow are counted, also across leaves",
                   "[inspect][lint]", openvdb::FloatGrid, openvdb::DoubleGrid) {
  openvdb::initialize();
  const double size = GENERATE(0.25, 1.0, 1000.0);
  const int axis = GENERATE(0, 1, 2);
  const int at = GENERATE(-9, -1, 3, 7);  // the next voxel may be in another leaf
  CAPTURE(size, axis, at);
  auto grid = TestType::create(typename TestType::ValueType(5 * size));
  grid->setTransform(openvdb::math::Transform::createLinearTransform(size));
  Coord low(5, 5, 2);
  low[axis] = at;
  Coord high = low;
  ++high[axis];
  const auto keepOnly = [&](double difference) {
    grid->tree().clear();
    grid->tree().setValueOn(low, typename TestType::ValueType(-0.5 * difference * size));
    grid->tree().setValueOn(high, typename TestType::ValueType(0.5 * difference * size));
  };
  keepOnly(1.09);
  CHECK(steepPairs(*grid).count == 0);
  keepOnly(1.11);
  const SteepPairs steep = steepPairs(*grid);
  CHECK(steep.count == 1);
  CHECK(steep.first == low);
  grid->tree().setValueOff(high);
  CHECK(steepPairs(*grid).count == 0);
}

TEST_CASE("each axis has its own voxel size, and values of 16 bits may be rounded",
          "[inspect][lint]") {
  openvdb::initialize();
  auto grid = openvdb::FloatGrid::create(5);
  grid->transform().preScale(openvdb::Vec3d(1, 1, 2));
  grid->tree().setValueOn({3, 3, 3}, 0);
  grid->tree().setValueOn({3, 3, 4}, 2);
  CHECK(steepPairs(*grid).count == 0);
  grid->tree().setValueOn({3, 4, 3}, 2);
  CHECK(steepPairs(*grid).count == 1);

  // Between 512 and 1024, values of 16 bits are 0.5 apart.
  auto far = openvdb::FloatGrid::create(1000);
  far->tree().setValueOn({0, 0, 7}, 700.0F);
  far->tree().setValueOn({0, 0, 8}, 701.5F);
  CHECK(steepPairs(*far).count == 1);
  far->setSaveFloatAsHalf(true);
  CHECK(steepPairs(*far).count == 0);
}

TEST_CASE("the number of steep pairs does not depend on threads", "[inspect][lint][parallel]") {
  openvdb::initialize();
  const auto sphere = openvdb::tools::createLevelSetSphere<openvdb::FloatGrid>(60, {}, 1);
  const std::array<Coord, 3> wrong = {Coord(60, 0, 0), Coord(0, -60, 0), Coord(0, 0, 60)};
  for (const Coord& voxel : wrong) sphere->tree().setValueOn(voxel, 2.9F);
  const auto count = [&] { return steepPairs(*sphere); };
  const SteepPairs one = onThreads(1, count);
  const SteepPairs many = onThreads(8, count);
  CHECK(one.count > 0);
  CHECK(one.count == many.count);
  CHECK(one.first == many.first);
}

TEST_CASE("values and names of vector grids are checked", "[inspect][lint]") {
  openvdb::initialize();
  auto grid = openvdb::Vec3SGrid::create();
  grid->setName("velocity");
  grid->tree().setValueOn({0, 0, 0}, {1, 2, 3});
  CHECK(codesOf(lintGrid(*grid)).empty());
  grid->tree().setValueOn({0, 0, 0}, {1, std::numeric_limits<float>::quiet_NaN(), 3});
  CHECK(codesOf(lintGrid(*grid)) == "not-finite");
  grid->tree().setValueOn({0, 0, 0}, {1, 2, 3});
  grid->setName("N");
  CHECK(codesOf(lintGrid(*grid)) == "name");
}

TEST_CASE("faults of a whole file are named", "[inspect][lint]") {
  CHECK(codesOfFile({fog()}).empty());
  CHECK(codesOfFile({fog("smoke")}) == "no-density");
  CHECK(codesOfFile({fog(), fog()}) == "name");
  CHECK(codesOfFile({fog()}, "Houdini/SOP_OpenVDB") == "creator");
}
