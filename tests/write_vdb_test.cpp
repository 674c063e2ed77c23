#include "libvox/io/write_vdb.h"

#include "libvox/core/error.h"
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

std::string bytesOf(const std::vector<openvdb::GridBase::Ptr>& grids) {
  std::stringstream stream(std::ios::in | std::ios::out | std::ios::binary);
  writeVdb(stream, grids, {});
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

TEST_CASE("a full disk is an error", "[io][error]") {
  if (!std::filesystem::exists("/dev/full")) return;
  std::fstream full("/dev/full", std::ios::in | std::ios::out | std::ios::binary);
  CHECK_THROWS_AS(writeVdb(full, someGrids(1), {}), IoError);
}
