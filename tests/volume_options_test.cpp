#include "libvox/options/volume_options.h"

#include "libvox/grid/openvdb.h"
#include "libvox/pipeline/convert.h"
#include "tests/conversion.h"
#include "tests/shapes.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>
#include <openvdb/io/Stream.h>

#include <algorithm>
#include <cmath>
#include <sstream>

using namespace vox;

namespace {

Scene pyramidScene() {
  Scene scene;
  scene.objects.push_back({"pyramid", test::pyramid(5)});
  return scene;
}

ConvertOptions coarse() {
  ConvertOptions options;
  options.voxelSize = 0.05;
  options.grids = std::vector{GridKind::kDensity, GridKind::kMask};
  return options;
}

openvdb::GridPtrVecPtr readBack(const std::string& bytes) {
  std::istringstream stream(bytes);
  return openvdb::io::Stream(stream, false).getGrids();
}

std::vector<openvdb::Coord> voxelsOf(const Conversion& conversion) {
  std::vector<openvdb::Coord> voxels;
  const auto& mask = dynamic_cast<const openvdb::MaskGrid&>(*conversion.grids.at(1));
  for (auto voxel = mask.cbeginValueOn(); voxel; ++voxel) voxels.push_back(voxel.getCoord());
  std::sort(voxels.begin(), voxels.end());
  return voxels;
}

}  // namespace

TEST_CASE("the text of a band has one width or two", "[options]") {
  CHECK(bandWidthsIn("3") == BandWidths(3));
  CHECK(bandWidthsIn("2,5.5") == BandWidths(2, 5.5));
  for (const char* text : {"", "a", ",", "1,", ",1", "1,2,3", "1 2", "1;2", "1,b", "3x"}) {
    CAPTURE(text);
    CHECK_FALSE(bandWidthsIn(text));
  }
}

TEST_CASE("the turn of the up axis is a rotation, and can be undone", "[volume]") {
  for (const Turn turn : {Turn::kNoTurn, Turn::kYToZ, Turn::kZToY}) {
    const GridTransform transform{0.5, turn};
    const Vec3d p(1, 2, 3);
    CHECK(transform.toWorld(transform.toIndex(p)) == p);
    const Vec3d x = transform.toIndex(Vec3d(1, 0, 0));
    const Vec3d y = transform.toIndex(Vec3d(0, 1, 0));
    const Vec3d z = transform.toIndex(Vec3d(0, 0, 1));
    CHECK(x.cross(y).dot(z) == 8);  // right-handed, twice as large
    CHECK(x == Vec3d(2, 0, 0));
    if (turn == Turn::kYToZ) CHECK(y == Vec3d(0, 0, 2));
    if (turn == Turn::kZToY) CHECK(z == Vec3d(0, 2, 0));
  }
}

TEST_CASE("nothing is turned unless the up axes of input and target differ", "[volume]") {
  CHECK(turnFor({}, Target::kBlender) == Turn::kNoTurn);
  CHECK(turnFor(UpAxis::kY, Target::kBlender) == Turn::kYToZ);
  CHECK(turnFor(UpAxis::kZ, Target::kBlender) == Turn::kNoTurn);
  CHECK(turnFor(UpAxis::kZ, Target::kHoudini) == Turn::kZToY);
  CHECK(turnFor(UpAxis::kY, Target::kHoudini) == Turn::kNoTurn);
  CHECK(turnFor({}, Target::kHoudini) == Turn::kNoTurn);
}

TEST_CASE("an input whose y axis points up gives the voxels of the input turned", "[volume]") {
  ConvertOptions options = coarse();
  options.volume.up = UpAxis::kY;
  const Conversion turned = convert(pyramidScene(), options);
  Scene scene = pyramidScene();
  for (Vec3d& p : scene.objects[0].mesh.points) p = Vec3d(p.x(), -p.z(), p.y());
  const Conversion plain = convert(scene, coarse());
  CHECK(voxelsOf(turned) == voxelsOf(plain));
  CHECK(voxelsOf(turned) != voxelsOf(convert(pyramidScene(), coarse())));
}

TEST_CASE("compression changes the size of a file, not its content", "[volume]") {
  openvdb::initialize();
  const auto grid = openvdb::FloatGrid::create();
  for (int i = 0; i < 20000; ++i)
    grid->tree().setValueOn({i % 37, i / 37 % 23, i / 851}, static_cast<float>(i % 5));
  std::vector<std::size_t> sizes;
  for (const auto& [compression, name] : kCompressionNames) {
    Conversion conversion;
    conversion.grids = {grid};
    conversion.compression = compression;
    const std::string bytes = test::bytesOf(conversion);
    sizes.push_back(bytes.size());
    const auto read = openvdb::gridPtrCast<openvdb::FloatGrid>(readBack(bytes)->at(0));
    REQUIRE(read->activeVoxelCount() == grid->activeVoxelCount());
    for (auto value = grid->cbeginValueOn(); value; ++value)
      REQUIRE(read->tree().getValue(value.getCoord()) == *value);
  }
  CHECK(sizes[0] < sizes[2] / 2);
  CHECK(sizes[1] < sizes[2] / 2);
}

TEST_CASE("half floats are read back as nearly equal floats", "[volume]") {
  ConvertOptions options = coarse();
  options.volume.gain = 1.0 / 3;
  options.volume.edge = Edge::kHard;
  options.volume.compression = Compression::kPlain;
  const std::string fullBytes = test::bytesOf(convert(pyramidScene(), options));
  options.volume.half = true;
  const std::string halfBytes = test::bytesOf(convert(pyramidScene(), options));
  CHECK(halfBytes.size() < fullBytes.size());
  const auto density = openvdb::gridPtrCast<openvdb::FloatGrid>(readBack(halfBytes)->at(0));
  for (auto value = density->cbeginValueOn(); value; ++value)
    REQUIRE(std::abs(*value * 3 - 1) < std::ldexp(1.0, -11));
}

TEST_CASE("grids for Blender 3.4 lie half a voxel lower, all of them once", "[volume]") {
  for (const bool maskFirst : {false, true}) {
    ConvertOptions options = coarse();
    if (maskFirst) options.grids = std::vector{GridKind::kMask, GridKind::kDensity};
    options.volume.target = Target::kBlender34;
    const Conversion conversion = convert(pyramidScene(), options);
    for (const auto& grid : conversion.grids)
      CHECK((grid->indexToWorld(openvdb::Coord(0)) - openvdb::Vec3d(-0.025)).length() < 1e-12);
    CHECK(conversion.grids[0]->transform() == conversion.grids[1]->transform());
  }
}
