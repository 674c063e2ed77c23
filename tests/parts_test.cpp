#include "libvox/grid/openvdb.h"
#include "libvox/io/read_mesh.h"
#include "libvox/pipeline/convert.h"
#include "libvox/pipeline/part_numbers.h"
#include "tests/conversion.h"
#include "tests/shapes.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <string>
#include <vector>

using namespace vox;

namespace {

const openvdb::Int32Grid& partOf(const Conversion& conversion, std::size_t grid = 0) {
  return dynamic_cast<const openvdb::Int32Grid&>(*conversion.grids.at(grid));
}
std::string partNamesOf(const Conversion& conversion) {
  return partOf(conversion).metaValue<std::string>("vox_part_names");
}

ConvertOptions partsAt(int dim) {
  ConvertOptions options;
  options.dim = dim;
  options.grids = std::vector{GridKind::kPart, GridKind::kMask};
  return options;
}

Scene sceneOf(PolygonMesh mesh) {
  Scene scene;
  scene.objects.push_back({"thing", std::move(mesh)});
  return scene;
}

/// A cube whose faces are sets of their own.
PolygonMesh cubeOfSets() {
  PolygonMesh cube = test::cube();
  for (Index f = 0; f < 6; ++f) {
    cube.attributes.groups.names.push_back("side " + std::to_string(f));
    cube.attributes.groups.ofFaces.push_back(f);
  }
  return cube;
}

}  // namespace

TEST_CASE("each active voxel, and no other, has the part of its closest face", "[parts]") {
  const PolygonMesh cube = cubeOfSets();
  const bool sharp = GENERATE(false, true);
  ConvertOptions options = partsAt(40);
  if (sharp) options.smoothing.crease = CreaseRule{.degrees = 20.0};
  const Conversion conversion = convert(sceneOf(cube), options);
  const openvdb::Int32Grid& part = partOf(conversion);
  CHECK(part.getName() == "part");
  CHECK(part.background() == 0);
  const auto& mask = dynamic_cast<const openvdb::MaskGrid&>(*conversion.grids.at(1));
  CHECK(part.tree().hasSameTopology(mask.tree()));
  CHECK(part.transform() == mask.transform());
  CHECK(partNamesOf(conversion) ==
        R"({"1":"side 0","2":"side 1","3":"side 2","4":"side 3","5":"side 4","6":"side 5"})");
  std::size_t checked = 0;
  for (auto voxel = part.cbeginValueOn(); voxel; ++voxel) {
    const openvdb::Vec3d at = part.indexToWorld(voxel.getCoord());
    // By symmetry, the closest face is that whose centre is nearest by angle.
    Index nearest = 0;
    double most = -10;
    double second = -10;
    for (Index f = 0; f < 6; ++f) {
      const double along = test::faceCentroid(cube, f).dot(Vec3d(at.x(), at.y(), at.z()));
      if (along > most) {
        second = most;
        most = along;
        nearest = f;
      } else {
        second = std::max(second, along);
      }
    }
    if (most - second < 1e-6) continue;
    ++checked;
    CHECK(*voxel == static_cast<int>(nearest) + 1);
  }
  CHECK(checked > 2000);
}

TEST_CASE("where objects meet, each voxel has the part of the nearest surface", "[parts]") {
  Scene scene;
  scene.objects.push_back({"left", test::moved(test::cube(), Vec3d(-1, 0, 0))});
  scene.objects.push_back({"right", test::moved(test::cube(), Vec3d(0.9, 0.2, 0))});
  ConvertOptions options = partsAt(60);
  options.until = StopRule{.levels = 0};
  const Conversion conversion = convert(scene, options);
  CHECK(partNamesOf(conversion) == R"({"1":"left","2":"right"})");
  const auto distance = [](const Vec3d& p, const Vec3d& middle) {
    const Vec3d q = (p - middle).cwiseAbs() - Vec3d::Ones();
    return std::abs(q.cwiseMax(0).norm() + std::min(q.maxCoeff(), 0.0));
  };
  std::size_t checked = 0;
  for (auto voxel = partOf(conversion).cbeginValueOn(); voxel; ++voxel) {
    const openvdb::Vec3d at = partOf(conversion).indexToWorld(voxel.getCoord());
    const Vec3d p(at.x(), at.y(), at.z());
    const double left = distance(p, Vec3d(-1, 0, 0));
    const double right = distance(p, Vec3d(0.9, 0.2, 0));
    if (std::abs(left - right) < 1e-3) continue;
    ++checked;
    CHECK(*voxel == (left < right ? 1 : 2));
  }
  CHECK(checked > 10000);
}

TEST_CASE("voxels inside a solid have the part of the surface nearest to them", "[parts][solid]") {
  const PolygonMesh cube = cubeOfSets();
  for (const bool withDensity : {false, true}) {
    ConvertOptions options = partsAt(48);
    options.volume.fill = Fill::kSolid;
    options.until = StopRule{.levels = 0};
    if (withDensity) options.grids = std::vector{GridKind::kPart, GridKind::kDensity};
    const Conversion conversion = convert(sceneOf(cube), options);
    const openvdb::Int32Grid& part = partOf(conversion);
    const double size = part.voxelSize().x();
    CHECK(part.activeVoxelCount() == 49 * 49 * 49);
    std::size_t wrong = 0;
    for (auto voxel = part.cbeginValueOn(); voxel; ++voxel) {
      REQUIRE(*voxel > 0);
      const openvdb::Vec3d at = part.indexToWorld(voxel.getCoord());
      const Vec3d p(at.x(), at.y(), at.z());
      const Vec3d side = test::faceCentroid(cube, static_cast<Index>(*voxel - 1));
      // The distance to its side is that to the nearest side, up to a voxel.
      wrong += 1 - side.dot(p) > 1 - p.cwiseAbs().maxCoeff() + 1.5 * size;
    }
    CHECK(wrong == 0);
  }
}

TEST_CASE("parts are what tells two apart: objects, else groups, else materials", "[parts]") {
  PolygonMesh mesh = test::together(test::cube(), test::cube(), Vec3d(5, 0, 0));
  std::vector<Index> halves(12, 0);
  for (Index f = 6; f < 12; ++f) halves[f] = 1;
  mesh.attributes.materials = {{"steel", "wood"}, halves};
  CHECK(partNamesOf(convert(sceneOf(mesh), partsAt(40))) == R"({"1":"steel","2":"wood"})");
  std::vector<Index> some(12, kNone);
  some[11] = 0;
  mesh.attributes.groups = {{"lid"}, some};
  CHECK(partNamesOf(convert(sceneOf(mesh), partsAt(40))) == R"({"1":"thing","2":"lid"})");
  mesh.attributes.objects = {{"a", "b"}, halves};
  CHECK(partNamesOf(convert(sceneOf(mesh), partsAt(40))) == R"({"1":"a","2":"b"})");
  Scene two = sceneOf(mesh);
  two.objects.push_back({"other", test::moved(test::cube(), Vec3d(0, 5, 0))});
  CHECK(partNamesOf(convert(two, partsAt(40))) == R"({"1":"thing/a","2":"thing/b","3":"other"})");
  ConvertOptions options = partsAt(40);
  options.partBy = PartBy::kMaterial;
  CHECK(partNamesOf(convert(two, options)) == R"({"1":"steel","2":"wood","3":"other"})");
}

TEST_CASE("names of parts are JSON whatever they hold", "[parts]") {
  CHECK(partNamesText({"a \"b\"\\\n", "\xc3\xa9", "\xff"}) ==
        "{\"1\":\"a \\\"b\\\"\\\\\\n\",\"2\":\"\xc3\xa9\",\"3\":\"\xef\xbf\xbd\"}");
}

TEST_CASE("parts do not depend on the number of threads", "[parts][parallel]") {
  ConvertOptions options = partsAt(90);
  options.volume.fill = Fill::kSolid;
  PolygonMesh mesh = test::torusGrid(12, 8);
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    mesh.attributes.groups.names.push_back(std::to_string(f));
    mesh.attributes.groups.ofFaces.push_back(f);
  }
  options.run.threads = 1;
  const Conversion one = convert(sceneOf(mesh), options);
  options.run.threads = 4;
  CHECK(test::bytesOf(convert(sceneOf(mesh), options)) == test::bytesOf(one));
}
