#include "libvox/core/error.h"
#include "libvox/grid/openvdb.h"
#include "libvox/pipeline/convert.h"
#include "libvox/pipeline/refine.h"
#include "libvox/pipeline/request.h"
#include "tests/shapes.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

using namespace vox;

namespace {

PolygonMesh somethingBad(std::mt19937& random) {
  const auto& closed = test::shapes();
  const auto& open = test::openShapes();
  PolygonMesh mesh =
      random() % 2 == 0 ? closed[random() % closed.size()].mesh : open[random() % open.size()].mesh;
  if (random() % 4 == 0) mesh = test::together(mesh, test::moebius(7), {0.5, 0.25, 0});
  if (random() % 4 == 0) mesh = test::unwelded(mesh);
  const auto mutations = random() % 12;
  for (std::size_t i = 0; i < mutations; ++i) test::mutate(mesh, random);
  return mesh;
}

Scene somethingBadTwice(std::mt19937& random) {
  Scene scene;
  scene.objects.push_back({"first", somethingBad(random)});
  if (random() % 3 == 0) scene.objects.push_back({"second", somethingBad(random)});
  return scene;
}

ConvertOptions anyOptions(std::mt19937& random, Index pointCount) {
  ConvertOptions options;
  options.dim = 4 + static_cast<int>(random() % 12);
  options.grids = std::vector{GridKind::kMask};
  options.run.maxMemory = std::uint64_t{1} << 28;
  if (random() % 3 == 0) options.weldTolerance = 0.1 * static_cast<double>(random() % 9);
  if (random() % 6 == 0) options.strict = true;
  SmoothingOptions& smoothing = options.smoothing;
  if (random() % 2 == 0) smoothing.interpolate = static_cast<Interpolate>(random() % 4);
  if (random() % 4 == 0) smoothing.boundary = BoundaryRule::kFree;
  if (random() % 4 == 0)
    smoothing.interpolatedVertices = std::vector<Index>{static_cast<Index>(random() % pointCount)};
  return options;
}

}  // namespace

TEST_CASE("any mutated mesh is converted, or refused with an error", "[pipeline][property]") {
  int converted = 0;
  int refused = 0;
  for (std::uint32_t seed = 0; seed < 1000; ++seed) {
    CAPTURE(seed);
    std::mt19937 random(seed);
    const Scene scene = somethingBadTwice(random);
    const ConvertOptions options = anyOptions(random, scene.objects[0].mesh.pointCount());
    try {
      const Conversion conversion = convert(scene, options);
      CHECK(conversion.report.activeVoxels > 0);
      const Refinement refined = refine(scene, 2, options, options.run);
      CHECK(test::faultOf(refined.mesh) == "");
      ++converted;
    } catch (const Error& error) {
      CHECK(error.exitCode() > 0);
      ++refused;
    }
  }
  CHECK(converted > 500);
  CHECK(refused > 50);
}

TEST_CASE("any mutated mesh becomes solids and level sets, or is refused with an error",
          "[pipeline][property]") {
  int converted = 0;
  for (std::uint32_t seed = 0; seed < 300; ++seed) {
    CAPTURE(seed);
    std::mt19937 random(seed);
    const Scene scene = somethingBadTwice(random);
    ConvertOptions options = anyOptions(random, scene.objects[0].mesh.pointCount());
    options.grids = std::vector{GridKind::kMask, GridKind::kDensity, GridKind::kSurface};
    options.volume.fill = Fill::kSolid;
    options.volume.edge = kEdgeNames[random() % 2].first;
    options.volume.openMesh = kOpenMeshNames[1 + random() % 2].first;
    try {
      const Conversion conversion = convert(scene, options);
      const auto& mask = dynamic_cast<const openvdb::MaskGrid&>(*conversion.grids[0]);
      const auto& solid = dynamic_cast<const openvdb::FloatGrid&>(*conversion.grids[1]);
      const auto& surface = dynamic_cast<const openvdb::FloatGrid&>(*conversion.grids[2]);
      const auto gain = solid.metaValue<float>("vox_gain");
      for (auto value = solid.cbeginValueOn(); value; ++value)
        REQUIRE((*value > 0 && *value <= gain));
      if (options.volume.edge == Edge::kHard) {
        CHECK(solid.activeVoxelCount() >= mask.activeVoxelCount());
        for (auto voxel = mask.cbeginValueOn(); voxel; ++voxel)
          REQUIRE(solid.tree().isValueOn(voxel.getCoord()));
      }
      for (auto value = surface.cbeginValueAll(); value; ++value)
        REQUIRE(std::abs(*value) <= surface.background());
      ++converted;
    } catch (const Error& error) {
      CHECK(error.exitCode() > 0);
    }
  }
  CHECK(converted > 150);
}

TEST_CASE("a mesh with one invalid index or coordinate is refused", "[pipeline][property]") {
  const double infinite = std::numeric_limits<double>::infinity();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  int possible = 0;
  for (std::uint32_t seed = 0; seed < 200; ++seed) {
    CAPTURE(seed);
    std::mt19937 random(seed);
    Scene scene = somethingBadTwice(random);
    PolygonMesh& mesh = scene.objects.back().mesh;
    if (seed % 2 == 0)
      mesh.faceVertices[random() % mesh.cornerCount()] =
          mesh.pointCount() + static_cast<Index>(random() % 1000);
    else
      mesh.points[random() % mesh.pointCount()][static_cast<int>(random() % 3)] =
          seed % 4 == 1 ? infinite : nan;
    const ConvertOptions options = anyOptions(random, mesh.pointCount());
    try {
      resolve(scene, options);
    } catch (const UsageError&) {
      continue;  // impossible options are refused before the meshes are looked at
    }
    ++possible;
    CHECK_THROWS_AS(convert(scene, options), MeshError);
  }
  CHECK(possible > 100);
}

TEST_CASE("meshes that are not manifolds are converted, and repairs are reported", "[pipeline]") {
  PolygonMesh doubled = test::cube();
  for (Index f = 0; f < 6; ++f) doubled.addFace(test::cube().face(f));
  const std::vector<std::pair<PolygonMesh, std::string>> cases = {
      {test::twoCones(), "split 1 vertex"},
      {test::bowTie(), "split 1 vertex"},
      {test::book(3), "cut 1 edge"},
      {test::book(7), "cut 1 edge"},
      {test::finOnSheet(), "cut 2 edges"},
      {test::together(test::cube(), test::cube(), {2, 2, 0}), "cut 1 edge"},
      {doubled, "dropped 6 duplicate faces"},
      {test::valenceTwo(), "chorded 1 vertex"},
      {test::insideOut(test::dodecahedron()), "flipped 12 faces"},
      {test::moebius(9), "doubled 1 one-sided component (face 0)"},
      {test::klein(9, 6), "doubled 1 one-sided component (face 0)"},
  };
  for (const auto& [mesh, done] : cases) {
    CAPTURE(done);
    Scene scene;
    scene.objects.push_back({"it", mesh});
    ConvertOptions options;
    options.dim = 32;
    const ConvertReport report = convert(scene, options).report;
    CHECK(report.activeVoxels > 100);
    const bool told =
        std::any_of(report.warnings.begin(), report.warnings.end(), [&](const std::string& line) {
          return line.starts_with("it: ") && line.find(done) != std::string::npos;
        });
    CHECK(told);
  }
}
