#include "libvox/core/error.h"
#include "libvox/grid/openvdb.h"
#include "libvox/pipeline/convert.h"
#include "libvox/volume/texture.h"
#include "tests/conversion.h"
#include "tests/shapes.h"

#include <catch2/catch.hpp>

#include <sstream>

using namespace vox;
using Catch::Contains;
using openvdb::Coord;

namespace {

Scene texturedScene(const PolygonMesh& mesh, const char* texture) {
  Scene scene;
  scene.objects.push_back({"object", mesh});
  scene.objects[0].texture = parseTexture(texture);
  return scene;
}

ConvertOptions colorAt(double voxelSize) {
  ConvertOptions options;
  options.voxelSize = voxelSize;
  options.grids = std::vector{GridKind::kColor, GridKind::kMask};
  return options;
}

const openvdb::MaskGrid& maskOf(const Conversion& conversion) {
  return dynamic_cast<const openvdb::MaskGrid&>(*conversion.grids.at(1));
}

Vec3d asDoubles(const openvdb::Vec3f& color) {
  return Vec3d(color.x(), color.y(), color.z());
}

}  // namespace

TEST_CASE("every active voxel, and no other, has the texture's colour at its centre", "[color]") {
  const PolygonMesh mesh = test::dodecahedron();
  const Conversion conversion = convert(texturedScene(mesh, "marble"), colorAt(0.1));
  const openvdb::Vec3SGrid& color = test::colorOf(conversion);

  CHECK(color.getName() == "color");
  CHECK(color.background() == openvdb::Vec3f(0));
  CHECK(color.transform() == maskOf(conversion).transform());
  CHECK(color.tree().hasSameTopology(maskOf(conversion).tree()));
  Box box;
  for (const Vec3d& p : mesh.points) box.add(p);
  const SolidTexture texture(parseTexture("marble"), box);
  for (auto voxel = color.cbeginValueOn(); voxel; ++voxel) {
    const Coord at = voxel.getCoord();
    const Vec3d expected = texture.colorAt(0.1 * Vec3d(at.x(), at.y(), at.z()));
    CHECK((asDoubles(*voxel) - expected).norm() < 1e-6);  // of floats
  }
}

TEST_CASE("a texture moves with its object, or stays in the world", "[color]") {
  // By whole voxels and a binary fraction, so that nothing is rounded.
  const Vec3d shift(16, 8, -4);
  const Coord shiftIndex(64, 32, -16);
  for (const bool inWorld : {false, true}) {
    CAPTURE(inWorld);
    const char* const texture =
        inWorld ? "checker:scale=3,space=world" : "checker:scale=3,space=object";
    const Conversion before = convert(texturedScene(test::cube(), texture), colorAt(0.25));
    Scene scene = texturedScene(test::moved(test::cube(), shift), texture);
    scene.objects[0].fromWorld = Eigen::Translation3d(-shift);
    const Conversion after = convert(scene, colorAt(0.25));
    std::size_t different = 0;
    for (auto voxel = test::colorOf(before).cbeginValueOn(); voxel; ++voxel)
      different += test::colorOf(after).tree().getValue(voxel.getCoord() + shiftIndex) != *voxel;
    CHECK(test::colorOf(before).activeVoxelCount() == test::colorOf(after).activeVoxelCount());
    CHECK((different == 0) == !inWorld);
  }
}

TEST_CASE("where objects share voxels, the colour of the later one stays", "[color]") {
  const PolygonMesh first = test::cube();
  const PolygonMesh second = test::moved(test::cube(), Vec3d(0.5, 0.25, 0));
  const auto red = parseTexture("checker:colors=1:0:0/1:0:0");
  const auto blue = parseTexture("checker:colors=0:0:1/0:0:1");
  Scene scene;
  scene.objects.push_back({"first", first});
  scene.objects.push_back({"second", second});
  scene.objects[0].texture = red;
  scene.objects[1].texture = blue;
  const Conversion both = convert(scene, colorAt(0.1));
  const Conversion onlyFirst = convert(texturedScene(first, "checker"), colorAt(0.1));
  const Conversion onlySecond = convert(texturedScene(second, "checker"), colorAt(0.1));

  const auto& inFirst = maskOf(onlyFirst).tree();
  const auto& inSecond = maskOf(onlySecond).tree();
  std::size_t shared = 0;
  for (auto voxel = test::colorOf(both).cbeginValueOn(); voxel; ++voxel) {
    const bool later = inSecond.isValueOn(voxel.getCoord());
    const bool earlier = inFirst.isValueOn(voxel.getCoord());
    REQUIRE((later || earlier));
    shared += later && earlier;
    CHECK(*voxel == (later ? openvdb::Vec3f(0, 0, 1) : openvdb::Vec3f(1, 0, 0)));
  }
  CHECK(shared > 10);
  // The voxels and their counts are those of a conversion without colours.
  ConvertOptions plain = colorAt(0.1);
  plain.grids = std::vector{GridKind::kMask};
  const Conversion without = convert(scene, plain);
  CHECK(dynamic_cast<const openvdb::MaskGrid&>(*without.grids[0])
            .tree()
            .hasSameTopology(maskOf(both).tree()));
  for (std::size_t i = 0; i < 2; ++i)
    CHECK(without.report.objects[i].activeVoxels == both.report.objects[i].activeVoxels);
}

TEST_CASE("a texture among the options wins over the scene's and adds the colour grid", "[color]") {
  ConvertOptions options;
  options.dim = 16;
  options.texture = parseTexture("checker:colors=0:1:0/0:1:0");
  const Conversion conversion = convert(texturedScene(test::cube(), "marble"), options);
  REQUIRE(conversion.grids.size() == 2);
  CHECK(conversion.grids[0]->getName() == "density");
  const auto& color = dynamic_cast<const openvdb::Vec3SGrid&>(*conversion.grids[1]);
  for (auto voxel = color.cbeginValueOn(); voxel; ++voxel) CHECK(*voxel == openvdb::Vec3f(0, 1, 0));

  options.grids = std::vector{GridKind::kMask};
  CHECK_THROWS_WITH(convert(texturedScene(test::cube(), "marble"), options),
                    Contains("--texture needs color among --grids"));
}

TEST_CASE("colours do not depend on threads", "[color][parallel]") {
  const auto bytes = [](int threads) {
    Scene scene = texturedScene(test::torusGrid(12, 6), "marble");
    scene.objects.push_back({"second", test::cube()});
    scene.objects[1].texture = parseTexture("brick");
    ConvertOptions options = colorAt(0.05);
    options.run.threads = threads;
    std::stringstream stream(std::ios::in | std::ios::out | std::ios::binary);
    writeGrids(stream, convert(scene, options));
    return stream.str();
  };
  CHECK(bytes(1) == bytes(8));
}
