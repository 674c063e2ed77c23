#include "libvox/inspect/diff.h"

#include "libvox/core/error.h"
#include "libvox/core/parallel.h"
#include "libvox/grid/openvdb.h"
#include "tests/temporary_folder.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <random>

using namespace vox;
using Catch::Contains;
using openvdb::Coord;
using openvdb::CoordBBox;

namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

template <class Grid>
typename Grid::Ptr gridNamed(const std::string& name,
                             typename Grid::ValueType background = typename Grid::ValueType()) {
  openvdb::initialize();
  auto grid = Grid::create(background);
  grid->setName(name);
  return grid;
}

/// Random boxes, which make tiles, and random voxels of a few values, around a corner of eight
/// leaves.
openvdb::FloatGrid::Ptr randomGrid(std::mt19937& random, bool tiles) {
  std::uniform_int_distribution<int> at(-12, 12);
  std::uniform_int_distribution<int> few(0, 3);
  const auto voxel = [&] { return Coord(at(random), at(random), at(random)); };
  auto grid = gridNamed<openvdb::FloatGrid>("density");
  for (int i = 0; i < 3 && tiles; ++i) {
    const Coord low(8 * few(random) - 16, 8 * few(random) - 16, 8 * few(random) - 16);
    grid->fill(CoordBBox::createCube(low, 8), static_cast<float>(few(random)), few(random) > 0);
  }
  for (int i = 0; i < 40; ++i) {
    const Coord where = voxel();
    grid->tree().setValueOn(where, static_cast<float>(few(random)));
    if (few(random) == 0) grid->tree().setValueOff(where, static_cast<float>(few(random)));
  }
  return grid;
}

/// The expected result, from each voxel of a box that holds both grids.
struct Expected {
  TopologyDiff topology;
  ValueDiff values;
};

double distanceTo(const Coord& from, const std::vector<Coord>& voxels) {
  double least = std::numeric_limits<double>::infinity();
  for (const Coord& voxel : voxels) least = std::min(least, (voxel - from).asVec3d().length());
  return least;
}

Expected compareVoxelByVoxel(const openvdb::FloatGrid& a, const openvdb::FloatGrid& b,
                             double tolerance) {
  Expected expected;
  TopologyDiff& topology = expected.topology;
  ValueDiff& values = expected.values;
  std::vector<Coord> inA, inB;
  double squares = 0;
  for (int x = -24; x < 24; ++x)
    for (int y = -24; y < 24; ++y)
      for (int z = -24; z < 24; ++z) {
        const Coord at(x, y, z);
        float valueA = 0;
        float valueB = 0;
        const bool onA = a.tree().probeValue(at, valueA);
        const bool onB = b.tree().probeValue(at, valueB);
        const double difference = std::abs(valueA - valueB);
        if (onA) inA.push_back(at);
        if (onB) inB.push_back(at);
        if (onA != onB) {
          ++(onA ? topology.onlyA : topology.onlyB);
          if (!topology.first) topology.first = VoxelIndex{x, y, z};
        } else if (onA) {
          ++values.compared;
          squares += difference * difference;
          values.largest = std::max(values.largest, difference);
          if (difference <= tolerance) continue;
          ++values.differing;
          if (!values.first) values.first = VoxelIndex{x, y, z};
        } else if (difference > tolerance) {
          ++values.inactiveDiffering;
        }
      }
  topology.active = {inA.size(), inB.size()};
  if (values.compared > 0) values.rms = std::sqrt(squares / static_cast<double>(values.compared));
  for (const Coord& at : inA) topology.distance = std::max(topology.distance, distanceTo(at, inB));
  for (const Coord& at : inB) topology.distance = std::max(topology.distance, distanceTo(at, inA));
  return expected;
}

void checkSame(const GridDiff& diff, const Expected& expected) {
  CHECK(diff.topology.active == expected.topology.active);
  CHECK(diff.topology.onlyA == expected.topology.onlyA);
  CHECK(diff.topology.onlyB == expected.topology.onlyB);
  CHECK(diff.topology.first == expected.topology.first);
  REQUIRE(diff.values);
  CHECK(diff.values->compared == expected.values.compared);
  CHECK(diff.values->differing == expected.values.differing);
  CHECK(diff.values->largest == expected.values.largest);
  CHECK(diff.values->rms == Approx(expected.values.rms));
  CHECK(diff.values->first == expected.values.first);
  CHECK(diff.values->inactiveDiffering == expected.values.inactiveDiffering);
}

template <class Grid>
void checkOneValue(const typename Grid::ValueType& one, const typename Grid::ValueType& other,
                   double size) {
  auto a = gridNamed<Grid>("g");
  a->tree().setValueOn({5, 6, 7}, one);
  a->tree().setValueOn({-100, 6, 7}, one);
  auto b = a->deepCopy();
  CHECK(diffGrids(*a, *b, {}).same());
  b->tree().setValueOn({5, 6, 7}, other);
  const GridDiff diff = diffGrids(*a, *b, {});
  CAPTURE(a->type());
  CHECK_FALSE(diff.same());
  CHECK(diff.topology.same());
  REQUIRE(diff.values);
  CHECK(diff.values->differing == 1);
  CHECK(diff.values->largest == Approx(size));
  CHECK(diff.values->rms == Approx(size / std::sqrt(2)));
  CHECK(diff.values->first == VoxelIndex{5, 6, 7});
}

/// Writes a file like other programs do, with a random UUID.
void writePlainly(const std::filesystem::path& file, const openvdb::GridPtrVec& grids) {
  openvdb::io::File(file.string()).write(grids);
}

}  // namespace

TEST_CASE("a comparison finds the same as a comparison voxel by voxel",
          "[inspect][diff][property]") {
  std::mt19937 random(1);
  for (int i = 0; i < 60; ++i) {
    CAPTURE(i);
    const bool tiles = i % 2 == 0;
    const auto a = randomGrid(random, tiles);
    const auto b = i % 3 == 0 ? a->deepCopy() : randomGrid(random, tiles);
    b->tree().setValueOn({i % 9, 3, -3}, 1.5F);
    if (i % 4 == 0) b->tree().prune();
    DiffOptions options;
    options.absoluteTolerance = i % 5 == 0 ? 1 : 0;
    const GridDiff diff = diffGrids(*a, *b, options);
    const Expected expected = compareVoxelByVoxel(*a, *b, options.absoluteTolerance);
    checkSame(diff, expected);
    if (tiles)
      CHECK(diff.topology.distance == Approx(expected.topology.distance).epsilon(0.01));
    else
      CHECK(diff.topology.distance == Approx(expected.topology.distance));
    CHECK(diff.same() ==
          (expected.topology.same() && expected.values.same() && diff.properties.empty()));
  }
}

TEST_CASE("a tile counts as its voxels", "[inspect][diff]") {
  auto tile = gridNamed<openvdb::FloatGrid>("g");
  tile->fill(CoordBBox::createCube({0, 0, 0}, 128), 2.0F, true);
  REQUIRE(tile->tree().leafCount() == 0);
  auto voxels = tile->deepCopy();
  voxels->tree().voxelizeActiveTiles();
  REQUIRE(voxels->tree().leafCount() == 16 * 16 * 16);
  CHECK(diffGrids(*tile, *voxels, {}).same());
  voxels->tree().setValueOff({64, 64, 64});
  const GridDiff diff = diffGrids(*tile, *voxels, {});
  CHECK(diff.topology.onlyA == 1);
  CHECK(diff.topology.distance == 1);
  CHECK(diff.values->compared == 128 * 128 * 128 - 1);
}

TEST_CASE("a huge tile costs no more than a small one", "[inspect][diff]") {
  auto a = gridNamed<openvdb::FloatGrid>("g");
  auto b = gridNamed<openvdb::FloatGrid>("g");
  a->fill(CoordBBox::createCube({0, 0, 0}, 4096), 2.0F, true);
  b->tree().setValueOn({0, 0, 0}, 2.0F);
  const GridDiff diff = diffGrids(*a, *b, {});
  CHECK(diff.topology.onlyA == (std::uint64_t{1} << 36U) - 1);
  CHECK(diff.topology.onlyB == 0);
  CHECK(diff.topology.distance == Approx(4095 * std::sqrt(3.0)).epsilon(0.01));
}

TEST_CASE("the distance of a cube from itself, moved, is how far it was moved",
          "[inspect][diff][golden]") {
  const auto cube = [](const Coord& low) {
    auto grid = gridNamed<openvdb::MaskGrid>("mask");
    for (const Coord& at : CoordBBox::createCube(low, 20)) grid->tree().setValueOn(at);
    return grid;
  };
  // Its corner is the farthest, from the corner of the other.
  CHECK(diffGrids(*cube({-5, 1, 2}), *cube({-2, 5, 14}), {}).topology.distance == 13);
  CHECK(diffGrids(*cube({-2, 5, 14}), *cube({-5, 1, 2}), {}).topology.distance == 13);
  CHECK(diffGrids(*cube({0, 0, 0}), *cube({1000, 0, 0}), {}).topology.distance == 1000);
}

TEST_CASE("values of every type are compared", "[inspect][diff]") {
  checkOneValue<openvdb::FloatGrid>(1.0F, 1.25F, 0.25);
  checkOneValue<openvdb::DoubleGrid>(1.0, 1.0 + 0x1p-50, 0x1p-50);
  checkOneValue<openvdb::Int32Grid>(3, -4, 7);
  checkOneValue<openvdb::Int64Grid>(std::int64_t{1} << 60, (std::int64_t{1} << 60) + 1, 1);
  checkOneValue<openvdb::BoolGrid>(true, false, 1);
  checkOneValue<openvdb::Vec3IGrid>({1, 2, 3}, {1, 5, 1}, 3);
  checkOneValue<openvdb::Vec3SGrid>({1, 2, 3}, {1, 2.5, 3}, 0.5);
  checkOneValue<openvdb::Vec3DGrid>({1, 2, 3}, {-1, 2, 3}, 2);
  const float far = std::numeric_limits<float>::infinity();
  checkOneValue<openvdb::FloatGrid>(kNan, 1.0F, far);
  checkOneValue<openvdb::FloatGrid>(far, -far, far);
}

TEST_CASE("tolerances are absolute and relative", "[inspect][diff]") {
  auto a = gridNamed<openvdb::FloatGrid>("g");
  a->tree().setValueOn({0, 0, 0}, 100.0F);
  auto b = a->deepCopy();
  b->tree().setValueOn({0, 0, 0}, 101.0F);
  const auto same = [&](double absolute, double relative) {
    return diffGrids(*a, *b, {absolute, relative, true, {}}).same();
  };
  CHECK(same(1, 0));
  CHECK_FALSE(same(0.99, 0));
  CHECK(same(0, 1 / 101.0 + 1e-9));
  CHECK_FALSE(same(0, 1 / 101.0 - 1e-4));
  CHECK(same(0.5, 0.5 / 101.0 + 1e-9));
  CHECK_THROWS_AS(same(-1, 0), UsageError);
  CHECK_THROWS_AS(same(0, kNan), UsageError);
}

TEST_CASE("topology is compared across types", "[inspect][diff]") {
  auto a = gridNamed<openvdb::FloatGrid>("g");
  a->tree().setValueOn({0, 0, 0}, 1.0F);
  auto b = gridNamed<openvdb::MaskGrid>("g");
  b->tree().setValueOn({0, 0, 3});
  const GridDiff diff = diffGrids(*a, *b, {});
  REQUIRE(diff.properties.size() == 1);
  CHECK(diff.properties[0].what == "type");
  CHECK(diff.topology.onlyA == 1);
  CHECK(diff.topology.onlyB == 1);
  CHECK(diff.topology.distance == 3);
  CHECK_FALSE(diff.values);
}

TEST_CASE("transforms, classes, backgrounds and metadata are compared", "[inspect][diff]") {
  const auto a = gridNamed<openvdb::FloatGrid>("g");
  const auto only = [&](const auto& b, const DiffOptions& options = {}) {
    const GridDiff diff = diffGrids(*a, *b, options);
    std::string what;
    for (const auto* texts : {&diff.properties, &diff.metadata})
      for (const TextDiff& text : *texts) what += text.what + "; ";
    CHECK(diff.same() == what.empty());
    return what;
  };
  auto b = a->deepCopy();
  CHECK(only(b).empty());
  b->setTransform(openvdb::math::Transform::createLinearTransform(0.5));
  CHECK(only(b) == "transform; ");
  b = a->deepCopy();
  b->setGridClass(openvdb::GRID_LEVEL_SET);
  CHECK(only(b) == "class; ");
  b = a->deepCopy();
  b->insertMeta("maker", openvdb::StringMetadata("me"));
  CHECK(only(b) == "maker; ");
  DiffOptions without;
  without.metadata = false;
  CHECK(only(b, without).empty());
  CHECK(only(gridNamed<openvdb::FloatGrid>("g", 1.0F)) == "background; ");
  // The same map by another name.
  b = a->deepCopy();
  b->setTransform(openvdb::math::Transform::createLinearTransform(openvdb::Mat4d::identity()));
  CHECK(only(b).empty());
}

TEST_CASE("files are compared by the names of their grids, not by UUID", "[inspect][diff]") {
  const test::TemporaryFolder folder;
  auto density = gridNamed<openvdb::FloatGrid>("density");
  density->tree().setValueOn({1, 2, 3}, 1.0F);
  const auto mask = gridNamed<openvdb::MaskGrid>("mask");
  writePlainly(folder / "a.vdb", {density, mask});
  writePlainly(folder / "b.vdb", {mask, density});
  CHECK(test::contentOf(folder / "a.vdb") != test::contentOf(folder / "b.vdb"));
  CHECK(diffVdb(folder / "a.vdb", folder / "b.vdb", {}).same());

  writePlainly(folder / "c.vdb", {density});
  const FileDiff diff = diffVdb(folder / "c.vdb", folder / "a.vdb", {});
  CHECK_FALSE(diff.same());
  REQUIRE(diff.grids.size() == 2);
  CHECK(diff.grids[0].same());
  CHECK(diff.grids[1].name == "mask");
  CHECK_FALSE(diff.grids[1].inA);
  CHECK(diff.grids[1].inB);
  DiffOptions options;
  options.onlyGrids = {"density"};
  CHECK(diffVdb(folder / "c.vdb", folder / "a.vdb", options).same());
  options.onlyGrids = {"fog"};
  CHECK_THROWS_WITH(diffVdb(folder / "c.vdb", folder / "a.vdb", options), Contains("'fog'"));
}

TEST_CASE("values of half precision are rounded in the file only", "[inspect][diff]") {
  const test::TemporaryFolder folder;
  auto grid = gridNamed<openvdb::FloatGrid>("density");
  grid->tree().setValueOn({1, 2, 3}, 1.0F / 3);
  writePlainly(folder / "full.vdb", {grid});
  grid->setSaveFloatAsHalf(true);
  writePlainly(folder / "half.vdb", {grid});
  DiffOptions options;
  options.metadata = false;  // "is_saved_as_half_float"
  const GridDiff diff = diffVdb(folder / "full.vdb", folder / "half.vdb", options).grids.at(0);
  CHECK(diff.values->differing == 1);
  CHECK(diff.values->largest < 1.0 / 3 / 2048);  // 11 bits, rounded
  options.relativeTolerance = 1.0 / 2048;
  CHECK(diffVdb(folder / "full.vdb", folder / "half.vdb", options).same());
}

TEST_CASE("the difference is written as grids", "[inspect][diff]") {
  const test::TemporaryFolder folder;
  auto a = gridNamed<openvdb::FloatGrid>("density");
  for (int x = 0; x < 10; ++x) a->tree().setValueOn({x, 0, 0}, 1.0F);
  auto b = a->deepCopy();
  b->tree().setValueOff({0, 0, 0});
  b->tree().setValueOn({0, 5, 0}, 1.0F);
  b->tree().setValueOn({9, 0, 0}, 3.0F);
  writePlainly(folder / "a.vdb", {a});
  writePlainly(folder / "b.vdb", {b});
  writeDifference(folder / "a.vdb", folder / "b.vdb", {}, folder / "d.vdb", false);
  openvdb::io::File file((folder / "d.vdb").string());
  file.open();
  const auto onlyVoxel = [&](const std::string& name) {
    const auto grid = file.readGrid(name);
    REQUIRE(grid->activeVoxelCount() == 1);
    return grid->evalActiveVoxelBoundingBox().min();
  };
  CHECK(onlyVoxel("density_only_a") == Coord(0, 0, 0));
  CHECK(onlyVoxel("density_only_b") == Coord(0, 5, 0));
  CHECK(onlyVoxel("density_difference") == Coord(9, 0, 0));
  CHECK_THROWS_AS(writeDifference(folder / "a.vdb", folder / "b.vdb", {}, folder / "d.vdb", false),
                  IoError);
}

TEST_CASE("a comparison does not depend on the number of threads", "[inspect][diff][parallel]") {
  std::mt19937 random(7);
  std::uniform_int_distribution<int> at(-300, 300);
  auto a = gridNamed<openvdb::FloatGrid>("g");
  auto b = gridNamed<openvdb::FloatGrid>("g");
  for (int i = 0; i < 20000; ++i)
    for (const auto& grid : {a, b})
      grid->tree().setValueOn({at(random) % 90, at(random) % 90, at(random)},
                              static_cast<float>(at(random)) / 7);
  const GridDiff one = onThreads(1, [&] { return diffGrids(*a, *b, {}); });
  CHECK(one.values->compared > 10);
  for (const int threads : {2, 8}) {
    const GridDiff more = onThreads(threads, [&] { return diffGrids(*a, *b, {}); });
    CHECK(more.topology.distance == one.topology.distance);
    CHECK(more.topology.first == one.topology.first);
    CHECK(more.values->rms == one.values->rms);
    CHECK(more.values->largest == one.values->largest);
  }
}

TEST_CASE("values that cannot be read from a file end in an error", "[inspect][diff][error]") {
  const test::TemporaryFolder folder;
  std::mt19937 random(3);
  auto grid = gridNamed<openvdb::FloatGrid>("density");
  for (int i = 0; i < 8 * 512; ++i)
    grid->tree().setValueOn(Coord(i % 8, i / 8 % 8, i / 64), static_cast<float>(random()));
  writePlainly(folder / "whole.vdb", {grid});
  const std::string whole = test::contentOf(folder / "whole.vdb");
  const auto cut = folder.write("cut.vdb", whole.substr(0, whole.size() - 3000));
  CHECK_THROWS_AS(diffVdb(folder / "whole.vdb", cut, {}), InputError);
}
