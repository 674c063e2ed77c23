#include "libvox/core/error.h"
#include "libvox/core/parallel.h"
#include "libvox/core/progress.h"
#include "libvox/grid/openvdb.h"
#include "libvox/inspect/diff.h"
#include "libvox/inspect/summary.h"
#include "libvox/io/read_nvdb.h"
#include "libvox/io/read_vdb.h"
#include "libvox/io/write_nvdb.h"
#include "libvox/pipeline/convert.h"
#include "tests/scenes.h"
#include "tests/shapes.h"
#include "tests/temporary_folder.h"

#include <catch2/catch.hpp>

#include <chrono>
#include <cstring>
#include <fstream>
#include <iterator>
#include <random>

using namespace vox;
using Catch::Contains;
using openvdb::Coord;
using openvdb::GridBase;

namespace {

std::string contentOf(const std::filesystem::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

void writeTo(const std::filesystem::path& file, const std::vector<GridBase::Ptr>& grids,
             std::optional<Compression> compression = {}) {
  std::fstream stream(file, std::ios::in | std::ios::out | std::ios::binary | std::ios::trunc);
  writeNvdb(stream, grids, compression);
}

/// A grid with tiles at each level, active and not, beside leaves; with nodes that have no active
/// voxels, in a place far off; turned and moved.
template <class Grid>
GridBase::Ptr gridOf(const std::string& name, typename Grid::ValueType a,
                     typename Grid::ValueType b) {
  openvdb::initialize();
  auto grid = Grid::create(a);
  grid->setName(name);
  auto& tree = grid->tree();
  for (int i = 0; i < 500; ++i) tree.setValueOn(Coord(i, 3 * i % 97, -i), i % 2 == 0 ? a : b);
  tree.setValueOff(Coord(7, 7, 7), b);
  tree.addTile(1, Coord(1024, 8, 0), b, true);
  tree.addTile(2, Coord(-2048, 0, 0), b, true);
  tree.addTile(3, Coord(-40960, 4096, 0), b, false);
  tree.touchLeaf(Coord(20000, -20000, 8));
  tree.addTile(1, Coord(1 << 20, -(1 << 20), 0), b, false);
  tree.addTile(2, Coord(1 << 21, 128, 0), b, false);
  auto transform = openvdb::math::Transform::createLinearTransform(0.1);
  transform->postRotate(0.3, openvdb::math::Y_AXIS);
  transform->postTranslate(openvdb::Vec3d(1.0 / 3, 2, -1e6));
  grid->setTransform(transform);
  return grid;
}

std::vector<GridBase::Ptr> gridsOfAllTypes() {
  using openvdb::Vec3s;
  auto fog = gridOf<openvdb::FloatGrid>("fog", 0, 0.1F);
  fog->setGridClass(openvdb::GRID_FOG_VOLUME);
  auto levelSet = gridOf<openvdb::DoubleGrid>("level set", 3, -1.0 / 3);
  levelSet->setGridClass(openvdb::GRID_LEVEL_SET);
  auto velocity = gridOf<openvdb::Vec3SGrid>("velocity", Vec3s(0), Vec3s(0.1F, -2, 3));
  velocity->setGridClass(openvdb::GRID_STAGGERED);
  return {fog,
          levelSet,
          velocity,
          gridOf<openvdb::Int32Grid>("part", 0, -7),
          gridOf<openvdb::Int64Grid>("id", -1, std::int64_t{1} << 40),
          gridOf<openvdb::MaskGrid>("mask", false, true),
          gridOf<openvdb::BoolGrid>("bool", false, true)};
}

/// No difference in anything but metadata.
void checkSame(const GridBase& a, const GridBase& b) {
  INFO(a.getName());
  DiffOptions options;
  options.metadata = false;
  const GridDiff diff = diffGrids(a, b, options);
  CHECK(b.getName() == a.getName());
  CHECK(diff.same());
  for (const TextDiff& text : diff.properties) CHECK(text.what + text.a == text.b);
  CHECK(diff.topology.same());
  CHECK(a.activeVoxelCount() == b.activeVoxelCount());
  CHECK(a.baseTree().leafCount() == b.baseTree().leafCount());
  CHECK(a.baseTree().nonLeafCount() == b.baseTree().nonLeafCount());
}

void checkHolds(const std::filesystem::path& file, const std::vector<GridBase::Ptr>& grids) {
  const VdbFile read = readVdb(file);
  REQUIRE(read.grids.size() == grids.size());
  for (std::size_t i = 0; i < grids.size(); ++i) checkSame(*grids[i], *read.grids[i].grid);
}

std::vector<GridBase::Ptr> smallGrids() {
  auto grid = openvdb::FloatGrid::create(0);
  grid->setName("small");
  for (int i = 0; i < 100; ++i)
    grid->tree().setValueOn(Coord(i, -i, i * i), 0.5F + static_cast<float>(i));
  auto mask = openvdb::MaskGrid::create();
  mask->setName("dot");
  mask->tree().setValueOn(Coord(1, 2, 3));
  return {grid, mask};
}

/// Calls work with the bytes of a file, and reads it. It must give grids or an InputError.
template <class Damage>
void checkRefusedOrSame(const std::string& bytes, const std::vector<GridBase::Ptr>& grids,
                        int times, std::size_t& refused, const Damage& damage) {
  const test::TemporaryFolder folder;
  for (int i = 0; i < times; ++i) {
    std::string copy = bytes;
    damage(i, copy);
    const auto file = folder.write("damaged.nvdb", copy);
    try {
      const VdbFile read = readVdb(file);
      if (grids.empty()) continue;
      REQUIRE(read.grids.size() == grids.size());
      for (std::size_t g = 0; g < grids.size(); ++g) checkSame(*grids[g], *read.grids[g].grid);
    } catch (const InputError& wrong) {
      ++refused;
      CHECK_THAT(wrong.what(), Contains("damaged.nvdb: "));
    }
  }
}

}  // namespace

TEST_CASE("a NanoVDB file of a conversion holds the grids of its OpenVDB file", "[nvdb]") {
  const test::TemporaryFolder folder;
  ConvertOptions options;
  options.dim = 40;
  options.grids = {GridKind::kMask,   GridKind::kDensity, GridKind::kSurface,
                   GridKind::kNormal, GridKind::kColor,   GridKind::kPart};
  const Conversion made = convert(test::sceneOf({test::cube(), test::dodecahedron()}), options);
  writeGrids(folder / "a.vdb", made, false);
  writeGrids(folder / "a.nvdb", made, false);
  DiffOptions diff;
  diff.metadata = false;
  const FileDiff found = diffVdb(folder / "a.vdb", folder / "a.nvdb", diff);
  CHECK(found.grids.size() == 6);
  for (const GridDiff& grid : found.grids) {
    INFO(grid.name);
    CHECK(grid.same());
    CHECK(grid.topology.active[0] > 0);
  }
  const auto vdb = summarizeVdb(folder / "a.vdb");
  const auto nvdb = summarizeVdb(folder / "a.nvdb");
  REQUIRE(vdb.size() == nvdb.size());
}

TEST_CASE("NanoVDB files keep every type, tile, node and transform, with every compression",
          "[nvdb]") {
  const test::TemporaryFolder folder;
  const auto grids = gridsOfAllTypes();
  for (const auto& [compression, name] : kCompressionNames) {
    INFO(name);
    writeTo(folder / "a.nvdb", grids, compression);
    checkHolds(folder / "a.nvdb", grids);
  }
}

TEST_CASE("NanoVDB files keep grids without voxels, equal names and long ones", "[nvdb]") {
  const test::TemporaryFolder folder;
  auto grids = smallGrids();
  grids.push_back(openvdb::FloatGrid::create(0.25F));
  auto inactive = openvdb::Int32Grid::create(3);
  inactive->tree().touchLeaf(Coord(9000, 0, 0));
  grids.push_back(inactive);
  grids.push_back(openvdb::MaskGrid::create());
  for (const auto& grid : grids) grid->setName("twin");
  grids[0]->setName(std::string(255, 'x'));
  grids[1]->setName(std::string(256, 'y') + "\xc3\xa9");
  writeTo(folder / "a.nvdb", grids);
  checkHolds(folder / "a.nvdb", grids);
  CHECK(readVdb(folder / "a.nvdb").grids[4].name == "twin[2]");
}

TEST_CASE("the bytes of a NanoVDB file are the same for any number of threads", "[nvdb]") {
  const test::TemporaryFolder folder;
  const auto grids = gridsOfAllTypes();
  for (const auto& [compression, name] : kCompressionNames) {
    INFO(name);
    onThreads(1, [&] { writeTo(folder / "a.nvdb", grids, compression); });
    const std::string bytes = contentOf(folder / "a.nvdb");
    for (int i = 0; i < 3; ++i) {
      onThreads(4, [&] { writeTo(folder / "b.nvdb", grids, compression); });
      CHECK(contentOf(folder / "b.nvdb") == bytes);
    }
  }
}

TEST_CASE("to write a NanoVDB file leaves the grids as they were", "[nvdb]") {
  const test::TemporaryFolder folder;
  const auto grids = gridsOfAllTypes();
  std::vector<GridBase::Ptr> copies;
  for (const auto& grid : grids) copies.push_back(grid->deepCopyGrid());
  writeTo(folder / "a.nvdb", grids);
  for (std::size_t i = 0; i < grids.size(); ++i) checkSame(*copies[i], *grids[i]);
}

TEST_CASE("a class that a type cannot have in NanoVDB becomes unknown", "[nvdb]") {
  const test::TemporaryFolder folder;
  const auto grids = smallGrids();
  grids[1]->setGridClass(openvdb::GRID_LEVEL_SET);
  writeTo(folder / "a.nvdb", grids);
  CHECK(readVdb(folder / "a.nvdb").grids[1].grid->getGridClass() == openvdb::GRID_UNKNOWN);
  CHECK(grids[1]->getGridClass() == openvdb::GRID_LEVEL_SET);
}

TEST_CASE("what NanoVDB cannot hold is refused", "[nvdb]") {
  const test::TemporaryFolder folder;
  openvdb::initialize();
  auto vectors = openvdb::Vec3DGrid::create();
  vectors->setName("wind");
  CHECK_THROWS_WITH(writeTo(folder / "a.nvdb", {vectors}),
                    Contains("grid wind: NanoVDB has no grids of type Tree_vec3d_5_4_3"));
  auto tapered = openvdb::FloatGrid::create();
  tapered->setTransform(openvdb::math::Transform::createFrustumTransform(
      openvdb::BBoxd(openvdb::Vec3d(0), openvdb::Vec3d(10)), 0.5, 10));
  CHECK_THROWS_AS(writeTo(folder / "a.nvdb", {tapered}), InputError);
}

TEST_CASE("a stream that fails is an IoError of NanoVDB files, too", "[nvdb]") {
  std::fstream full("/dev/full", std::ios::in | std::ios::out | std::ios::binary);
  CHECK_THROWS_AS(writeNvdb(full, smallGrids(), Compression::kPlain), IoError);
}

TEST_CASE("a conversion can be cancelled while its NanoVDB file is written", "[nvdb]") {
  const test::TemporaryFolder folder;
  Progress* run = nullptr;
  Progress progress(
      [&](double, const char* stage) {
        if (stage == std::string("write")) run->cancel();
      },
      std::chrono::nanoseconds(0));
  run = &progress;
  ConvertOptions options;
  options.dim = 100;
  options.volume.compression = Compression::kPlain;
  options.run.progress = &progress;
  const Conversion made = convert(test::oneObject(test::cube()), options);
  CHECK_THROWS_AS(writeGrids(folder / "out.nvdb", made, false, &progress), Cancelled);
  CHECK(folder.fileCount() == 0);
}

TEST_CASE("other files are not NanoVDB files", "[nvdb]") {
  const test::TemporaryFolder folder;
  writeTo(folder / "a.nvdb", smallGrids());
  std::string bytes = contentOf(folder / "a.nvdb");
  CHECK_THROWS_WITH(readVdb(folder / "none.nvdb"), Contains("none.nvdb: no such file"));
  CHECK_THROWS_WITH(readVdb(folder.write("b.nvdb", "")), Contains("b.nvdb: the file is empty"));
  CHECK_THROWS_WITH(readVdb(folder.write("b.nvdb", "neither NanoVDB nor anything")),
                    Contains("b.nvdb: is not a NanoVDB file"));
  bytes[7] = '2';
  CHECK_THROWS_WITH(readVdb(folder.write("b.nvdb", bytes)),
                    Contains("b.nvdb: is of a newer NanoVDB than this one, version 32"));
  bytes[7] = '0';
  bytes[11] = 5;  // the top of the major version
  CHECK_THROWS_WITH(readVdb(folder.write("b.nvdb", bytes)), Contains("b.nvdb: is of NanoVDB 4"));
}

TEST_CASE("truncated NanoVDB files are refused", "[nvdb]") {
  const test::TemporaryFolder folder;
  for (const auto& [compression, name] : kCompressionNames) {
    INFO(name);
    writeTo(folder / "a.nvdb", {smallGrids()[1]}, compression);
    const std::string bytes = contentOf(folder / "a.nvdb");
    const int times = 200;
    std::size_t refused = 0;
    checkRefusedOrSame(bytes, {}, times, refused, [&](int i, std::string& copy) {
      copy.resize(1 + copy.size() * static_cast<std::size_t>(i) / times);
    });
    CHECK(refused == times);
    CHECK_THROWS_AS(readVdb(folder.write("longer.nvdb", bytes + "x")), InputError);
  }
}

TEST_CASE("a changed byte of a NanoVDB file is found, or changes no grid", "[nvdb]") {
  const test::TemporaryFolder folder;
  const std::vector<GridBase::Ptr> grids = {smallGrids()[1]};
  for (const auto& [compression, name] : kCompressionNames) {
    INFO(name);
    writeTo(folder / "a.nvdb", grids, compression);
    std::mt19937 random(17);
    const int times = 150;
    std::size_t refused = 0;
    checkRefusedOrSame(contentOf(folder / "a.nvdb"), grids, times, refused,
                       [&](int i, std::string& copy) {
                         const std::size_t head = 16 + 176 + 4 + 672 + 64 + 96;  // to the root
                         const std::size_t at =
                             random() % (i % 2 == 0 ? std::min(head, copy.size()) : copy.size());
                         copy[at] = static_cast<char>(copy[at] ^ (1 << random() % 8));
                       });
    CHECK(refused > times / 3);
  }
}

TEST_CASE("a NanoVDB file without checksums cannot lead out of its grids", "[nvdb]") {
  const test::TemporaryFolder folder;
  writeTo(folder / "a.nvdb", smallGrids(), Compression::kPlain);
  std::string bytes = contentOf(folder / "a.nvdb");
  const std::string magic = bytes.substr(0, 8);
  bool isGrid = false;  // the magic of a segment comes first, then that of its grid
  for (std::size_t at = 0; at != bytes.npos; at = bytes.find(magic, at + 8), isGrid = !isGrid)
    if (isGrid) std::memset(&bytes[at + 8], 0xff, 8);  // no checksum
  checkHolds(folder.write("b.nvdb", bytes), smallGrids());
  std::vector<std::size_t> words;  // those that are not 0: offsets, masks, sizes
  for (std::size_t at = 0; at + 8 <= bytes.size(); at += 8)
    if (bytes.compare(at, 8, std::string(8, '\0')) != 0) words.push_back(at);
  std::mt19937 random(18);
  std::size_t refused = 0;
  checkRefusedOrSame(bytes, {}, 500, refused, [&](int i, std::string& copy) {
    const std::size_t at = words[i % 2 == 0 ? random() % 300 : random() % words.size()];
    std::uint64_t word = 0;
    std::memcpy(&word, &copy[at], sizeof word);
    switch (random() % 4) {
      case 0:
        word += 32 * (random() % 8) - 96;
        break;
      case 1:
        word ^= std::uint64_t{1} << random() % 64;
        break;
      case 2:
        word = 0;
        break;
      default:
        word = std::uint64_t{random()} << 32 | random();
        break;
    }
    std::memcpy(&copy[at], &word, sizeof word);
  });
  CHECK(refused > 100);
}
