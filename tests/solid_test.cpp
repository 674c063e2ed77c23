// Solid densities, from mesh to grid.

#include "libvox/core/error.h"
#include "libvox/grid/openvdb.h"
#include "libvox/pipeline/convert.h"
#include "tests/scenes.h"
#include "tests/shapes.h"
#include "tests/spline_torus.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <sstream>
#include <string>
#include <vector>

using namespace vox;
using Catch::Contains;
using openvdb::Coord;
using test::sceneOf;

namespace {

ConvertOptions solidAt(double voxelSize) {
  ConvertOptions options;
  options.voxelSize = voxelSize;
  options.volume.fill = Fill::kSolid;
  return options;
}

const openvdb::FloatGrid& densityOf(const Conversion& conversion) {
  return dynamic_cast<const openvdb::FloatGrid&>(*conversion.grids.at(0));
}

bool isOn(const Conversion& conversion, const Vec3d& world) {
  const Vec3d index = world / conversion.report.voxelSize;
  return densityOf(conversion)
      .tree()
      .isValueOn(Coord::round(openvdb::Vec3d(index.x(), index.y(), index.z())));
}

}  // namespace

TEST_CASE("the volume of a solid torus converges to that of its spline with order 1",
          "[solid][golden]") {
  const test::SplineTorus torus(12, 8);
  const double volume = torus.volume();
  std::vector<double> errors;
  for (const double size : {1.0 / 40, 1.0 / 80, 1.0 / 160, 1.0 / 320}) {
    const Conversion conversion = convert(sceneOf({test::torusGrid(12, 8)}), solidAt(size));
    const auto voxels = static_cast<double>(densityOf(conversion).activeVoxelCount());
    errors.push_back(voxels * size * size * size / volume - 1);
    CAPTURE(size, errors.back());
    CHECK(errors.back() > 0);  // the active voxels reach out by half a voxel or so
  }
  for (std::size_t i = 1; i < errors.size(); ++i) {
    const double order = std::log2(errors[i - 1] / errors[i]);
    CHECK(order == Approx(1).margin(0.1));
  }
  CHECK(errors.back() < 0.03);
}

TEST_CASE("an inward shell is a cavity, and what lies in it is solid", "[solid]") {
  const PolygonMesh outer = test::scaled(test::cube(), 4);
  const PolygonMesh cavity = test::insideOut(test::scaled(test::cube(), 2.5));
  const PolygonMesh core = test::cube();
  PolygonMesh all = test::together(outer, cavity, Vec3d(0, 0, 0));
  all = test::together(all, core, Vec3d(0, 0, 0));
  const PolygonMesh plate = test::scaled(test::cube(), 0.5);

  for (const bool asPolygons : {false, true}) {
    ConvertOptions options = solidAt(0.1);
    if (asPolygons) options.until = StopRule{2};
    const Conversion conversion = convert(sceneOf({all}), options);
    CHECK(conversion.report.warnings.empty());
    for (const double sign : {-1.0, 1.0}) {
      CHECK(isOn(conversion, sign * Vec3d(3, 0, 0)));
      CHECK_FALSE(isOn(conversion, sign * Vec3d(0, 1.8, 0)));
    }
    CHECK(isOn(conversion, Vec3d(0, 0, 0)));

    // Another object in the cavity, and one that overlaps its wall.
    const Conversion more = convert(sceneOf({all, test::together({}, plate, Vec3d(0, 1.8, 0)),
                                             test::together({}, plate, Vec3d(3, 0, 0), 4)}),
                                    options);
    CHECK(isOn(more, Vec3d(0, 1.8, 0)));
    CHECK(isOn(more, Vec3d(1.8, 0, 0)));
    CHECK_FALSE(isOn(more, Vec3d(0, -1.8, 0)));
    CHECK_FALSE(isOn(more, Vec3d(-1.8, 0, 0)));
  }
}

TEST_CASE("an outward shell within another is solid like all of it", "[solid]") {
  const PolygonMesh nested =
      test::together(test::scaled(test::cube(), 4), test::scaled(test::cube(), 2), Vec3d(0, 0, 0));
  const Conversion conversion = convert(sceneOf({nested}), solidAt(0.1));
  for (const double x : {0.0, 1.0, 2.0, 3.0}) CHECK(isOn(conversion, Vec3d(x, 0, 0)));
  CHECK_FALSE(isOn(conversion, Vec3d(4.5, 0, 0)));
}

TEST_CASE("a closed object is filled beside an open one, and the open one is named", "[solid]") {
  const Scene scene =
      sceneOf({test::cube(), test::together({}, test::sheet(4, 4), Vec3d(5, 5, 5))});
  ConvertOptions options = solidAt(0.05);
  const Conversion conversion = convert(scene, options);
  CHECK(isOn(conversion, Vec3d(0, 0, 0)));
  REQUIRE(conversion.report.warnings.size() == 1);
  CHECK_THAT(conversion.report.warnings[0],
             Contains("object 2: 1 of its 1 component has no inside") &&
                 Contains("of 16 faces, is open at (5, 5, 5)"));

  options.volume.openMesh = OpenMesh::kError;
  CHECK_THROWS_WITH(convert(scene, options), Contains("object 2") && Contains("--open-mesh"));
  CHECK_THROWS_AS(convert(scene, options), MeshError);
  options.grids = std::vector{GridKind::kMask};  // needs no inside
  CHECK_NOTHROW(convert(scene, options));
}

TEST_CASE("a mesh with an open and a closed component is filled where it is closed", "[solid]") {
  const PolygonMesh both = test::together(test::cube(), test::moebius(12), Vec3d(9, 0, 0));
  const Conversion conversion = convert(sceneOf({both}), solidAt(0.05));
  CHECK(isOn(conversion, Vec3d(0, 0, 0)));
  CHECK_THAT(conversion.report.warnings.back(), Contains("1 of its 2 components has no inside"));
}

TEST_CASE("a gain is the value of every voxel", "[solid]") {
  for (const Fill fill : {Fill::kSurface, Fill::kSolid}) {
    ConvertOptions options = solidAt(0.05);
    options.volume.fill = fill;
    options.volume.gain = 2.5;
    const Conversion conversion = convert(sceneOf({test::cube()}), options);
    CHECK(densityOf(conversion).background() == 0);
    for (auto value = densityOf(conversion).cbeginValueOn(); value; ++value)
      REQUIRE(*value == 2.5F);
  }
  ConvertOptions options;
  for (const double gain : {0.0, -1.0, 1e300, std::nan("")}) {
    options.volume.gain = gain;
    CHECK_THROWS_AS(convert(sceneOf({test::cube()}), options), UsageError);
  }
}

TEST_CASE("a voxel is opaque in Blender, whatever the unit of length", "[solid]") {
  const auto valueFor = [](double voxelSize, Target target) {
    ConvertOptions options = solidAt(voxelSize);
    options.volume.target = target;
    options.volume.edge = Edge::kHard;
    const Scene scene = sceneOf({test::scaled(test::cube(), 20 * voxelSize)});
    return densityOf(convert(scene, options)).cbeginValueOn().getValue();
  };
  // Beer-Lambert: exp(-value * length) of the light passes.
  for (const double voxelSize : {0.001, 0.05, 3.0, 1000.0})
    CHECK(std::exp(-voxelSize * static_cast<double>(valueFor(voxelSize, Target::kBlender))) <
          0.0025);
  CHECK(valueFor(1000, Target::kBlender) >= 1);     // Blender drops values up to 0.001
  CHECK(valueFor(2e-5, Target::kBlender) < 65504);  // the largest half float
  CHECK(valueFor(0.001, Target::kHoudini) == 1);
}

TEST_CASE("any number of threads makes the same solid", "[solid][parallel]") {
  const Scene scene =
      sceneOf({test::together(test::torusGrid(24, 12), test::insideOut(test::torusGrid(12, 6)),
                              Vec3d(0, 0, 0), 0.9),
               test::sheet(3, 3)});
  const auto bytes = [&](int threads) {
    ConvertOptions options = solidAt(0.01);
    options.run.threads = threads;
    std::stringstream stream(std::ios::in | std::ios::out | std::ios::binary);
    writeGrids(stream, convert(scene, options));
    return stream.str();
  };
  const std::string one = bytes(1);
  CHECK(bytes(2) == one);
  CHECK(bytes(8) == one);
}
