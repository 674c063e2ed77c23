#include "libvox/io/write_vdb.h"

#include "libvox/core/error.h"
#include "libvox/core/parallel.h"
#include "libvox/grid/openvdb.h"
#include "tests/failing_allocation.h"
#include "tests/temporary_folder.h"

#include <catch2/catch.hpp>

#include <fstream>
#include <sstream>

using namespace vox;

namespace {

std::vector<openvdb::GridBase::Ptr> someGrids(int value) {
  openvdb::initialize();
  auto density = openvdb::FloatGrid::create();
  density->setName("density");
  for (int i = 0; i < 1000; ++i)
    density->tree().setValueOn({i, 3 * i % 97, value}, static_cast<float>(i));
  auto mask = openvdb::MaskGrid::create();
  mask->setName("mask");
  mask->tree().setValueOn({1, 2, 3});
  return {density, mask};
}

/// Grids with more leaves than are written at a time, and with values of inactive voxels.
std::vector<openvdb::GridBase::Ptr> gridsOfManyLeaves() {
  constexpr int kSide = 18;  // leaves
  const openvdb::Vec3s flat(0, 0, 1);
  auto mask = openvdb::MaskGrid::create();
  auto distance = openvdb::FloatGrid::create(3);
  auto half = openvdb::FloatGrid::create(0);
  auto normal = openvdb::Vec3SGrid::create(openvdb::Vec3s(0, 0, 0));
  auto id = openvdb::Int32Grid::create(-1);  // a type without special treatment
  for (int i = 0; i < kSide * kSide * kSide; ++i) {
    const openvdb::Coord at(8 * (i / kSide / kSide) + i % 8, 8 * (i / kSide % kSide) - 50,
                            8 * (i % kSide));
    mask->tree().setValueOn(at);
    distance->tree().setValueOn(at, static_cast<float>(i % 100) / 64);
    distance->tree().setValueOff(at.offsetBy(0, 1, 0), -3);
    half->tree().setValueOn(at, static_cast<float>(i) / 7);
    normal->tree().setValueOn(at, flat);
    id->tree().setValueOn(at, i);
  }
  distance->setGridClass(openvdb::GRID_LEVEL_SET);
  half->setSaveFloatAsHalf(true);
  mask->setName("mask");
  distance->setName("distance");
  half->setName("half");
  normal->setName("normal");
  id->setName("id");
  return {mask, distance, half, normal, id};
}

/// A grid whose internal nodes have tiles of all kinds: none, inactive ones of one, two and more
/// values, active ones, and all of these; at every level, beside leaves.
template <class GridT>
openvdb::GridBase::Ptr gridOfTiles(const std::vector<typename GridT::ValueType>& values,
                                   bool half) {
  auto grid = GridT::create(values.front());
  auto& tree = grid->tree();
  const int kinds = static_cast<int>(values.size());
  for (int level = 1; level <= 3; ++level) {
    const int side = level == 1 ? 8 : level == 2 ? 128 : 4096;     // of a tile
    const int node = level == 1 ? 128 : level == 2 ? 4096 : 8192;  // of what holds it
    for (int kind = 0; kind <= kinds; ++kind)
      for (const bool active : {false, true})
        for (int i = 0; i < kind; ++i)
          tree.addTile(
              static_cast<openvdb::Index>(level),
              {-20000 + node * kind + side, 20000 * level + (active ? 2 * node : 0), i * side},
              values[static_cast<std::size_t>(i)], active);
  }
  for (int i = 0; i < 3000; ++i) {
    const openvdb::Coord at(i * 37 % 1000, 20000 + i * 11 % 500, i * 7 - 9000);
    tree.setValue(at, values[static_cast<std::size_t>(i % kinds)]);
    tree.setValueOff(at.offsetBy(0, 0, 1), values[static_cast<std::size_t>(i / 7 % kinds)]);
  }
  tree.touchLeaf({-5000, -5000, -5000});  // without active voxels
  grid->setSaveFloatAsHalf(half);
  return grid;
}

/// Every type of grid that is written in parallel.
std::vector<openvdb::GridBase::Ptr> gridsOfTiles() {
  using openvdb::Vec3s;
  std::vector<openvdb::GridBase::Ptr> grids;
  for (const bool half : {false, true}) {
    grids.push_back(gridOfTiles<openvdb::MaskGrid>({false, true}, half));
    grids.push_back(gridOfTiles<openvdb::FloatGrid>({0.1F, -0.1F, 2.3F, 0, 1e9F}, half));
    grids.push_back(gridOfTiles<openvdb::Int32Grid>({-1, 1, 7, 0, 1 << 30}, half));
    grids.push_back(gridOfTiles<openvdb::Vec3SGrid>(
        {Vec3s(0.1F, 0, 0), Vec3s(-0.1F, 0, 0), Vec3s(0, 0, 1), Vec3s(3, 1 / 3.0F, 1)}, half));
  }
  for (const auto& grid : std::vector(grids)) grids.push_back(grid->copyGridWithNewTree());
  for (auto& grid : grids) grid->setName(grid->type());
  return grids;
}

std::string bytesOf(const std::vector<openvdb::GridBase::Ptr>& grids,
                    std::optional<Compression> compression = {}) {
  std::stringstream stream(std::ios::in | std::ios::out | std::ios::binary);
  writeVdb(stream, grids, {}, compression);
  return stream.str();
}

std::string uuidOf(const std::string& bytes) {
  return bytes.substr(21, 36);
}

}  // namespace

TEST_CASE("equal grids give equal bytes", "[io]") {
  CHECK(bytesOf(someGrids(1)) == bytesOf(someGrids(1)));
}

TEST_CASE("different grids give different UUIDs in the form of RFC 9562", "[io]") {
  const std::string one = uuidOf(bytesOf(someGrids(1)));
  const std::string two = uuidOf(bytesOf(someGrids(2)));
  CHECK(one != two);
  CHECK(one[14] == '8');                                          // version
  CHECK(std::string("89ab").find(one[19]) != std::string::npos);  // variant
}

TEST_CASE("OpenVDB reads back every voxel and the UUID", "[io]") {
  const test::TemporaryFolder folder;
  const auto grids = someGrids(5);
  const std::string bytes = bytesOf(grids);
  openvdb::io::File file(folder.write("grids.vdb", bytes).string());
  file.open();
  CHECK(file.getUniqueTag() == uuidOf(bytes));
  const auto density = openvdb::gridPtrCast<openvdb::FloatGrid>(file.readGrid("density"));
  const auto mask = openvdb::gridPtrCast<openvdb::MaskGrid>(file.readGrid("mask"));
  CHECK(density->activeVoxelCount() == 1000);
  for (int i = 0; i < 1000; ++i)
    CHECK(density->tree().getValue({i, 3 * i % 97, 5}) == static_cast<float>(i));
  CHECK(mask->tree().isValueOn({1, 2, 3}));
}

TEST_CASE("grids have the bytes that OpenVDB alone would write", "[io][parallel]") {
  openvdb::initialize();
  const auto withoutUuid = [](std::string bytes) { return bytes.replace(21, 36, 36, '-'); };
  auto grids = gridsOfManyLeaves();
  for (const auto& grid : gridsOfTiles()) grids.push_back(grid);
  for (const auto compression : {Compression::kBlosc, Compression::kZip, Compression::kPlain})
    for (const auto& grid : grids) {
      CAPTURE(nameIn(kCompressionNames, compression), grid->getName(), grid->saveFloatAsHalf(),
              grid->activeVoxelCount());
      const test::TemporaryFolder folder;
      const auto path = folder.path() / "grid.vdb";
      openvdb::io::File file(path.string());
      file.setCompression(openvdb::io::COMPRESS_ACTIVE_MASK |
                          (compression == Compression::kBlosc ? openvdb::io::COMPRESS_BLOSC
                           : compression == Compression::kZip ? openvdb::io::COMPRESS_ZIP
                                                              : openvdb::io::COMPRESS_NONE));
      file.write({grid});
      std::ifstream written(path, std::ios::binary);
      const std::string theirs(std::istreambuf_iterator<char>(written), {});
      for (const int threads : {1, 2, 8}) {
        const bool same = onThreads(threads, [&] {
          return withoutUuid(bytesOf({grid}, compression)) == withoutUuid(theirs);
        });
        CHECK(same);
      }
    }
}

TEST_CASE("memory that runs out while leaves are written is an error", "[io][error]") {
  if (!test::FailingAllocation::possible()) return;
  auto full = openvdb::Vec3SGrid::create();
  full->tree().denseFill({{0, 0, 0}, {55, 39, 39}}, {1, 2, 3});
  const std::vector<openvdb::GridBase::Ptr> grid = {full};
  constexpr std::size_t kLarge = 8192;  // larger than a leaf: only buffers for many leaves
  bool failed = true;
  int failures = 0;
  for (int n = 0; failed; ++n) {
    std::stringstream stream(std::ios::in | std::ios::out | std::ios::binary);
    stream.str(std::string(1 << 22, ' '));  // so that the stream itself does not allocate
    bool threw = false;
    {
      const test::FailingAllocation allocation(n, kLarge);
      try {
        onThreads(1, [&] { writeVdb(stream, grid, {}, Compression::kPlain); });
      } catch (const std::bad_alloc&) {
        threw = true;
      }
      failed = allocation.failed();
    }
    CAPTURE(n);
    REQUIRE(threw == failed);
    failures += failed;
  }
  CHECK(failures > 10);
}

TEST_CASE("a full disk is an error", "[io][error]") {
  if (!std::filesystem::exists("/dev/full")) return;
  std::fstream full("/dev/full", std::ios::in | std::ios::out | std::ios::binary);
  CHECK_THROWS_AS(writeVdb(full, someGrids(1), {}), IoError);
}
