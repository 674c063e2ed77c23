#include "libvox/inspect/diff.h"

#include "libvox/core/error.h"
#include "libvox/core/parallel.h"
#include "libvox/grid/openvdb.h"
#include "libvox/inspect/diff_folders.h"
#include "libvox/io/read_vdb.h"
#include "libvox/io/write_junit.h"
#include "libvox/io/write_vdb.h"
#include "tests/temporary_folder.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>
#include <sstream>
#include <string>
#include <vector>

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

/// Writes a file as vox does, with a hash.
void writeOwn(const std::filesystem::path& file, const openvdb::GridPtrVec& grids) {
  std::stringstream stream;
  writeVdb(stream, grids, {});
  std::ofstream(file, std::ios::binary) << stream.str();
}

void checkSame(const GridDiff& found, const GridDiff& expected) {
  const auto texts = [](const std::vector<TextDiff>& all) {
    std::string text;
    for (const TextDiff& one : all) text += one.what + ": " + one.a + ", " + one.b + "; ";
    return text;
  };
  CHECK(found.name == expected.name);
  CHECK(found.same() == expected.same());
  CHECK(texts(found.properties) == texts(expected.properties));
  CHECK(texts(found.metadata) == texts(expected.metadata));
  CHECK(found.topology.active == expected.topology.active);
  CHECK(found.topology.onlyA == expected.topology.onlyA);
  CHECK(found.topology.onlyB == expected.topology.onlyB);
  CHECK(found.topology.first == expected.topology.first);
  CHECK(found.topology.distance == expected.topology.distance);
  REQUIRE(found.values.has_value() == expected.values.has_value());
  if (!found.values) return;
  CHECK(found.values->compared == expected.values->compared);
  CHECK(found.values->differing == expected.values->differing);
  CHECK(found.values->largest == expected.values->largest);
  CHECK(found.values->rms == expected.values->rms);
  CHECK(found.values->inactiveDiffering == expected.values->inactiveDiffering);
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

TEST_CASE("files of vox that share bytes are compared as all others", "[inspect][diff][property]") {
  const test::TemporaryFolder folder;
  std::mt19937 random(11);
  const auto compared = [&](const openvdb::GridPtrVec& a, const openvdb::GridPtrVec& b) {
    writeOwn(folder / "a.vdb", a);
    writeOwn(folder / "b.vdb", b);
    const FileDiff found = diffVdb(folder / "a.vdb", folder / "b.vdb", {});
    const VdbFile fileA = readVdb(folder / "a.vdb");
    const VdbFile fileB = readVdb(folder / "b.vdb");
    for (const GridDiff& diff : found.grids) {
      const auto in = [&](const VdbFile& file) {
        return std::find_if(file.grids.begin(), file.grids.end(),
                            [&](const NamedGrid& one) { return one.name == diff.name; });
      };
      CHECK(diff.inA == (in(fileA) != fileA.grids.end()));
      CHECK(diff.inB == (in(fileB) != fileB.grids.end()));
      if (!diff.inA || !diff.inB) continue;
      GridDiff expected = diffGrids(*in(fileA)->grid, *in(fileB)->grid, {});
      expected.name = diff.name;
      checkSame(diff, expected);
    }
    return found;
  };
  for (int i = 0; i < 12; ++i) {
    CAPTURE(i);
    const auto density = randomGrid(random, i % 2 == 0);
    auto mask = gridNamed<openvdb::MaskGrid>("mask");
    mask->tree().topologyUnion(density->tree());
    auto colors = gridNamed<openvdb::Vec3SGrid>("color");
    for (auto voxel = density->cbeginValueOn(); voxel; ++voxel)
      if (voxel.isVoxelValue()) colors->tree().setValueOn(voxel.getCoord(), {*voxel, kNan, 1});
    auto flags = gridNamed<openvdb::BoolGrid>("flags");
    flags->tree().topologyUnion(density->tree());
    CHECK(compared({density, mask, colors, flags}, {flags, colors, mask, density}).same());

    auto other = density->deepCopy();
    other->tree().setValueOn({1, 2, 3}, 17.0F);
    const FileDiff values = compared({density, mask, colors}, {other, mask, flags});
    CHECK_FALSE(values.same());
    auto moved = mask->deepCopy();
    moved->setTransform(openvdb::math::Transform::createLinearTransform(0.5));
    moved->insertMeta("maker", openvdb::StringMetadata("me"));
    const FileDiff heads = compared({density, mask}, {density, moved});
    CHECK(heads.grids[0].same());
    CHECK(heads.grids[1].properties.size() == 1);
    CHECK(heads.grids[1].metadata.size() == 1);
    auto halves = density->deepCopy();
    halves->setSaveFloatAsHalf(true);
    compared({density}, {halves});
    auto second = density->deepCopy();  // two grids of one name
    compared({density, second, mask}, {density, other, mask});
    DiffOptions options;
    options.onlyGrids = {"density"};
    writeOwn(folder / "a.vdb", {density, mask});
    writeOwn(folder / "b.vdb", {density, flags});
    CHECK(diffVdb(folder / "a.vdb", folder / "b.vdb", options).same());
    CHECK(diffVdb(folder / "a.vdb", folder / "b.vdb", options).grids.size() == 1);
    options.onlyGrids = {"density", "fog"};
    CHECK_THROWS_WITH(diffVdb(folder / "a.vdb", folder / "b.vdb", options), Contains("'fog'"));
  }
}

TEST_CASE("a damaged file is an error, even if the other has the same bytes",
          "[inspect][diff][error]") {
  const test::TemporaryFolder folder;
  std::mt19937 random(5);
  writeOwn(folder / "a.vdb", {randomGrid(random, false)});
  std::string bytes = test::contentOf(folder / "a.vdb");
  bytes[bytes.size() - 40] = static_cast<char>(bytes[bytes.size() - 40] ^ 1);
  const auto b = folder.write("b.vdb", bytes);
  const auto c = folder.write("c.vdb", bytes);
  CHECK_THROWS_WITH(diffVdb(folder / "a.vdb", b, {}), Contains("b.vdb: is damaged"));
  CHECK_THROWS_WITH(diffVdb(b, c, {}), Contains("b.vdb: is damaged"));
  // Of another program, without a hash.
  writePlainly(folder / "plain.vdb", {randomGrid(random, false)});
  bytes = test::contentOf(folder / "plain.vdb");
  const auto d = folder.write("d.vdb", bytes.substr(0, bytes.size() - 100));
  const auto e = folder.write("e.vdb", bytes.substr(0, bytes.size() - 100));
  CHECK_THROWS_WITH(diffVdb(d, e, {}), Contains("d.vdb: is truncated"));
}

TEST_CASE("voxels may move by as much as is allowed", "[inspect][diff][property]") {
  std::mt19937 random(21);
  for (int i = 0; i < 40; ++i) {
    const auto a = randomGrid(random, false);
    auto b = a->deepCopy();
    if (i % 2 == 0) {
      b = gridNamed<openvdb::FloatGrid>("density");
      for (auto voxel = a->cbeginValueOn(); voxel; ++voxel)
        b->tree().setValueOn(voxel.getCoord().offsetBy(i % 3, (i / 3) % 2, 0), *voxel);
    } else {
      b->tree().setValueOn({i % 13, -i % 13, 4}, 1.0F);
    }
    const Expected expected = compareVoxelByVoxel(*a, *b, 0);
    const double distance = expected.topology.distance;
    for (const double allowed : {0.0, 0.5, 1.0, 1.5, 2.0, distance, 10.0}) {
      DiffOptions options;
      options.voxelTolerance = allowed;
      const GridDiff diff = diffGrids(*a, *b, options);
      checkSame(diff, expected);  // what differs is told as ever
      CHECK(diff.topology.distance == Approx(distance));
      CHECK(diff.topology.same() == (distance <= allowed));
    }
  }
  DiffOptions options;
  options.voxelTolerance = -1;
  const auto grid = randomGrid(random, false);
  CHECK_THROWS_AS(diffGrids(*grid, *grid, options), UsageError);
  // Nothing is near a grid without voxels.
  options.voxelTolerance = 1e9;
  auto none = gridNamed<openvdb::FloatGrid>("density");
  CHECK_FALSE(diffGrids(*grid, *none, options).topology.same());
}

TEST_CASE("folders are compared by the names of their files", "[inspect][diff]") {
  const test::TemporaryFolder folder;
  std::mt19937 random(31);
  const auto grid = randomGrid(random, false);
  auto other = grid->deepCopy();
  other->tree().setValueOn(grid->cbeginValueOn().getCoord(), 99.0F);
  for (const std::string name : {"a/sub/deep", "b/sub/deep"})
    std::filesystem::create_directories(folder / name);
  for (const std::string name : {"a/same.vdb", "b/same.vdb", "a/sub/deep/x.vdb", "a/only.vdb",
                                 "b/sub/more.VDB", "a/bad.vdb"})
    writeOwn(folder / name, {grid});
  writeOwn(folder / "b/sub/deep/x.vdb", {other});
  folder.write("b/bad.vdb", "nothing");
  folder.write("b/notes.txt", "no grids");
  const FolderDiff diff = diffFolders(folder / "a", folder / "b", {});
  CHECK_FALSE(diff.same());
  std::string found;
  for (const FilePairDiff& file : diff.files)
    found += file.name +
             (!file.inB             ? " A"
              : !file.inA           ? " B"
              : !file.error.empty() ? " error"
              : file.same()         ? " same"
                                    : " differs") +
             "\n";
  CHECK(found ==
        "bad.vdb error\nonly.vdb A\nsame.vdb same\nsub/deep/x.vdb differs\nsub/more.VDB B\n");
  CHECK(diff.files[0].exitCode == 3);
  CHECK(diff.files[3].diff.grids.at(0).values->differing == 1);
  CHECK(diffFolders(folder / "a", folder / "a", {}).same());
  DiffOptions options;
  options.onlyGrids = {"density"};
  CHECK(diffFolders(folder / "a", folder / "a", options).same());
  options.onlyGrids = {"fog"};
  CHECK_THROWS_WITH(diffFolders(folder / "a", folder / "a", options), Contains("'fog'"));
  std::filesystem::create_directories(folder / "none");
  CHECK_THROWS_WITH(diffFolders(folder / "none", folder / "none", {}), Contains("neither folder"));
}

TEST_CASE("reports for CI escape what XML cannot hold", "[inspect][diff][io]") {
  const auto written = [](const std::string& name, const std::string& text) {
    std::ostringstream out;
    writeJunit(out, {"suite", {{"good"}, {name, JunitCase::Result::kFailed, text}}});
    return out.str();
  };
  CHECK(written("a", "b\nc") ==
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
        "<testsuites tests=\"2\" failures=\"1\" errors=\"0\">\n"
        "  <testsuite name=\"suite\" tests=\"2\" failures=\"1\" errors=\"0\" skipped=\"0\">\n"
        "    <testcase classname=\"suite\" name=\"good\"/>\n"
        "    <testcase classname=\"suite\" name=\"a\">\n"
        "      <failure message=\"b\">b\nc</failure>\n"
        "    </testcase>\n  </testsuite>\n</testsuites>\n");
  const auto named = [&](const std::string& name) {
    const std::string all = written(name, "");
    const std::size_t begin = all.rfind("name=\"") + 6;
    return all.substr(begin, all.find("\">", begin) - begin);
  };
  CHECK(named("<script>&\"") == "&lt;script&gt;&amp;&quot;");
  CHECK(named("a\tb\nc\rd") == "a&#9;b&#10;c&#13;d");
  CHECK(named("\u00e9\u20ac\U0001F600") == "\u00e9\u20ac\U0001F600");
  const std::string other = "\uFFFD";
  CHECK(named(std::string("a\0\x1b", 3)) == "a" + other + other);
  CHECK(named("\xff") == other);
  CHECK(named("\xe2\x82") == other + other);              // cut short
  CHECK(named("\xc0\xaf") == other + other);              // overlong
  CHECK(named("\xed\xa0\x80") == other + other + other);  // half a surrogate pair
  CHECK(named("\xef\xbf\xbf") == other + other + other);  // U+FFFF
  CHECK(named("\xf5\x80\x80\x80") == other + other + other + other);
}
