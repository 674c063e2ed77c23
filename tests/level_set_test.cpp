// The grid `surface`, from mesh to level set.

#include "libvox/core/error.h"
#include "libvox/grid/openvdb.h"
#include "libvox/inspect/lint.h"
#include "libvox/pipeline/convert.h"
#include "libvox/subdivide/doo_sabin.h"
#include "tests/closest_point.h"
#include "tests/repaired_level.h"
#include "tests/scenes.h"
#include "tests/shapes.h"
#include "tests/spline_torus.h"

#include <catch2/catch.hpp>
#include <openvdb/io/Stream.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <string>
#include <vector>

using namespace vox;
using Catch::Contains;
using openvdb::Coord;
using test::sceneOf;

namespace {

ConvertOptions surfaceAt(double voxelSize) {
  ConvertOptions options;
  options.voxelSize = voxelSize;
  options.grids = std::vector{GridKind::kSurface};
  return options;
}

openvdb::FloatGrid::ConstPtr surfaceOf(const Conversion& conversion) {
  return openvdb::gridConstPtrCast<openvdb::FloatGrid>(
      openvdb::GridBase::ConstPtr(conversion.grids.at(0)));
}

openvdb::FloatGrid::ConstPtr levelSet(std::vector<PolygonMesh> meshes, double voxelSize) {
  return surfaceOf(convert(sceneOf(std::move(meshes)), surfaceAt(voxelSize)));
}

Vec3d worldOf(const openvdb::FloatGrid& grid, const Coord& voxel) {
  return Vec3d(grid.indexToWorld(voxel).asPointer());
}

float valueAt(const openvdb::FloatGrid& grid, const Vec3d& world) {
  const auto index = grid.worldToIndex(openvdb::Vec3d(world.data()));
  return grid.tree().getValue(Coord::round(index));
}

/// Points of the limit surface: the centroids of the faces of a deep level.
std::vector<Vec3d> limitSamples(const PolygonMesh& mesh, int levels) {
  const PolygonMesh fine = subdivide(baseLevel(mesh), levels).mesh;
  std::vector<Vec3d> samples;
  for (Index f = 0; f < fine.faceCount(); ++f) samples.push_back(test::faceCentroid(fine, f));
  return samples;
}

double distanceTo(const std::vector<Vec3d>& samples, const Vec3d& p) {
  double least = std::numeric_limits<double>::infinity();
  for (const Vec3d& s : samples) least = std::min(least, (s - p).squaredNorm());
  return std::sqrt(least);
}

}  // namespace

TEST_CASE("distances to a torus are those of its spline within 0.05 voxels rms, with their sign",
          "[level-set][golden]") {
  const test::SplineTorus torus(12, 8);
  for (const double size : {1.0 / 10, 1.0 / 50}) {
    for (const double band : {3.0, 6.0}) {
      ConvertOptions options = surfaceAt(size);
      options.volume.band = band;
      const Conversion conversion = convert(sceneOf({test::torusGrid(12, 8)}), options);
      const auto grid = surfaceOf(conversion);
      CHECK(grid->background() == Approx(band * size));
      double sum = 0;
      double largest = 0;
      int count = 0;
      int seen = 0;
      for (auto value = grid->cbeginValueOn(); value; ++value) {
        if (++seen % (size < 0.05 ? 101 : 7) != 0) continue;
        const double truth = torus.distance(worldOf(*grid, value.getCoord()));
        const double error = (double{*value} - truth) / size;
        sum += error * error;
        if (std::abs(truth) < size) largest = std::max(largest, std::abs(error));
        ++count;
      }
      CAPTURE(size, band, count, largest);
      CHECK(count > 300);
      CHECK(std::sqrt(sum / count) <= 0.05);
      CHECK(largest <= 0.05);  // farther off, meshToVolume itself errs by up to 0.2 in places
    }
  }
}

TEST_CASE("distances around extraordinary vertices and faces are as exact", "[level-set]") {
  for (const auto& mesh : {test::cube(), test::prism(7), test::pyramid(6)}) {
    const auto grid = levelSet({mesh}, 0.05);
    constexpr int kLevels = 7;
    const std::vector<Vec3d> samples = limitSamples(mesh, kLevels);
    double largest = 0;
    int seen = 0;
    for (auto value = grid->cbeginValueOn(); value; ++value) {
      // Beyond two voxels, the distance to a sample is as good as that to the surface.
      if (std::abs(*value) < 0.1 || ++seen % 53 != 0) continue;
      const double truth = distanceTo(samples, worldOf(*grid, value.getCoord()));
      largest = std::max(largest, std::abs(std::abs(double{*value}) - truth) / 0.05);
    }
    CHECK(seen > 2000);
    CHECK(largest < 0.06);
  }
}

TEST_CASE("the level set of a closed mesh is sound", "[level-set][property]") {
  for (const auto& shape : test::shapes()) {
    if (!shape.closed) continue;
    CAPTURE(shape.name);
    const auto grid = levelSet({shape.mesh}, 0.04);
    CHECK(grid->getName() == "surface");
    CHECK(grid->getGridClass() == openvdb::GRID_LEVEL_SET);
    for (const LintFinding& finding : lintGrid(*grid)) {
      CAPTURE(finding.message);
      CHECK(finding.code != "level-set");
    }
    CHECK(valueAt(*grid, Vec3d(100, 100, 100)) == grid->background());
    float lowest = 1;
    for (auto value = grid->cbeginValueOn(); value; ++value) lowest = std::min(lowest, *value);
    CHECK(lowest < 0);
    for (auto value = grid->cbeginValueOff(); value; ++value)
      REQUIRE(std::abs(*value) == grid->background());
  }
}

TEST_CASE("overlapping objects and components are united", "[level-set]") {
  const PolygonMesh a = test::cube();
  const PolygonMesh b = test::moved(a, Vec3d(1, 0.3, 0));
  const auto gridA = levelSet({a}, 0.05);
  const auto gridB = levelSet({b}, 0.05);
  for (const auto& both :
       {levelSet({a, b}, 0.05), levelSet({test::together(a, b, Vec3d(0, 0, 0))}, 0.05)}) {
    int inBoth = 0;
    for (auto value = both->cbeginValueOn(); value; ++value) {
      const Coord at = value.getCoord();
      const float least = std::min(gridA->tree().getValue(at), gridB->tree().getValue(at));
      constexpr float kSmall = 0.02F * 0.05F;
      // Nearer than this to where they cross, voxels are too coarse to tell the sides.
      constexpr float kAtCrossing = 0.25F * 0.05F;
      if (least > kAtCrossing)
        REQUIRE(*value == Approx(least).margin(kSmall));
      else if (least > 0)
        REQUIRE(*value == Approx(least).margin(kAtCrossing));
      else
        REQUIRE(*value <= kSmall);
      ++inBoth;
    }
    CHECK(inBoth > 10000);
    CHECK(valueAt(*both, Vec3d(0.5, 0.1, 0)) == -both->background());
  }
}

TEST_CASE("inside a union distances are those to its boundary", "[level-set][property]") {
  const double voxelSize = 0.05;
  const PolygonMesh a = test::cube();
  const PolygonMesh b = test::moved(a, Vec3d(1, 0.3, 0));
  constexpr int kLevels = 14;
  const test::ClosestPoint surfaceA(test::repairedLevel(a, 1), kLevels);
  const test::ClosestPoint surfaceB(test::repairedLevel(b, 1), kLevels);
  std::vector<Vec3d> exposed;
  constexpr std::uint64_t kSamples = 100000;
  for (std::uint64_t i = 0; i < kSamples; ++i) {
    const Vec3d onA = surfaceA.sample(i).point;
    const Vec3d onB = surfaceB.sample(i).point;
    if (surfaceB.of(onA).signedDistance > 0) exposed.push_back(onA);
    if (surfaceA.of(onB).signedDistance > 0) exposed.push_back(onB);
  }
  const auto grid = levelSet({a, b}, voxelSize);
  int seen = 0;
  int found = 0;
  double sum = 0;
  double largest = 0;
  for (auto value = grid->cbeginValueOn(); value; ++value) {
    if (*value > -voxelSize || ++seen % 29 != 0) continue;
    const double truth = distanceTo(exposed, worldOf(*grid, value.getCoord()));
    const double error = (-double{*value} - truth) / voxelSize;
    largest = std::max(largest, std::abs(error));
    sum += error * error;
    ++found;
  }
  CHECK(found > 300);
  CAPTURE(largest);
  CHECK(std::sqrt(sum / found) < 0.05);
  CHECK(largest < 0.3);
}

TEST_CASE("where a component crosses itself, distances change no faster than the place",
          "[level-set][property]") {
  // A tube around a figure of eight that crosses itself.
  constexpr int kMajor = 40, kMinor = 10;
  PolygonMesh tube = test::torusGrid(kMajor, kMinor);
  for (Vec3d& p : tube.points) {
    const double angle = std::atan2(p.y(), p.x());
    const double around = std::hypot(p.x(), p.y());
    constexpr double kMiddle = 1;  // radius of the torus
    const Vec3d centre(2 * std::sin(angle), std::sin(2 * angle), 0.15 * std::cos(angle));
    const Vec3d along =
        Vec3d(2 * std::cos(angle), 2 * std::cos(2 * angle), -0.15 * std::sin(angle)).normalized();
    const Vec3d side = along.cross(Vec3d(0, 0, 1)).normalized();
    p = centre + (around - kMiddle) * side + p.z() * side.cross(along);
  }
  for (const double voxelSize : {0.06, 0.025}) {
    CAPTURE(voxelSize);
    const auto grid = levelSet({tube}, voxelSize);
    for (const LintFinding& finding : lintGrid(*grid)) {
      CAPTURE(finding.message);
      CHECK(finding.code != "level-set");
    }
    // The tubes meet in the middle, where the inside of one goes on in the other.
    CHECK(valueAt(*grid, Vec3d(0, 0, 0)) == -grid->background());
    CHECK(valueAt(*grid, Vec3d(0, 0, 0.15)) == -grid->background());
  }
}

TEST_CASE("a component that faces inward is a cavity, and components in it are solid",
          "[level-set]") {
  const PolygonMesh cube = test::cube();
  PolygonMesh all =
      test::together(test::moved(cube, Vec3d(0, 0, 0), 4),
                     test::insideOut(test::moved(cube, Vec3d(0, 0, 0), 2.5)), Vec3d(0, 0, 0));
  all = test::together(all, cube, Vec3d(0, 0, 0));
  for (const auto& grid :
       {levelSet({all}, 0.1), levelSet({test::moved(cube, Vec3d(0, 0, 20)), all}, 0.1)}) {
    CHECK(valueAt(*grid, Vec3d(5, 0, 0)) > 0);
    CHECK(valueAt(*grid, Vec3d(3.2, 0, 0)) < 0);
    CHECK(valueAt(*grid, Vec3d(1.7, 0, 0)) > 0);
    CHECK(valueAt(*grid, Vec3d(0, 0, 0)) < 0);
    // The cube passes through the centres of its faces.
    CHECK(valueAt(*grid, Vec3d(2.4, 0, 0)) == Approx(0.1).margin(0.01));
    CHECK(valueAt(*grid, Vec3d(2.7, 0, 0)) == Approx(-0.2).margin(0.01));
    CHECK(valueAt(*grid, Vec3d(0, 1.1, 0)) == Approx(0.1).margin(0.01));
  }
}

TEST_CASE("an open mesh is a sheet one voxel thick, or distances without sign, or an error",
          "[level-set]") {
  PolygonMesh flat = test::sheet(4, 4);
  for (Vec3d& p : flat.points) p.z() = 0.013;
  ConvertOptions options = surfaceAt(0.1);
  const Conversion sheet = convert(sceneOf({flat}), options);
  CHECK_THAT(sheet.report.warnings.at(0), Contains("has no inside"));
  options.volume.openMesh = OpenMesh::kUnsigned;
  const auto distances = surfaceOf(convert(sceneOf({flat}), options));
  CHECK(surfaceOf(sheet)->getGridClass() == openvdb::GRID_LEVEL_SET);
  CHECK(distances->getGridClass() == openvdb::GRID_UNKNOWN);
  for (const auto& grid : {surfaceOf(sheet), distances}) {
    CHECK(grid->background() == Approx(0.3));
    CHECK(grid->activeVoxelCount() > 1000);
    for (auto value = grid->cbeginValueOff(); value; ++value) REQUIRE(*value == grid->background());
  }
  for (int k = -2; k <= 2; ++k) {
    const Vec3d at(2, 2, 0.1 * k);
    const double distance = std::abs(0.1 * k - 0.013);
    CHECK(valueAt(*distances, at) == Approx(distance).margin(1e-6));
    CHECK(valueAt(*surfaceOf(sheet), at) == Approx(distance - 0.05).margin(1e-6));
  }
  options.volume.openMesh = OpenMesh::kError;
  CHECK_THROWS_AS(convert(sceneOf({flat}), options), MeshError);
}

TEST_CASE("a closed object keeps its sign beside an open one", "[level-set]") {
  for (const OpenMesh policy : {OpenMesh::kSurface, OpenMesh::kUnsigned}) {
    ConvertOptions options = surfaceAt(0.1);
    options.volume.openMesh = policy;
    const Conversion conversion =
        convert(sceneOf({test::sheet(4, 4), test::moved(test::cube(), Vec3d(9, 0, 0))}), options);
    CHECK(valueAt(*surfaceOf(conversion), Vec3d(9, 0, 0)) == -surfaceOf(conversion)->background());
    CHECK(valueAt(*surfaceOf(conversion), Vec3d(10.1, 0, 0)) > 0);
  }
}

TEST_CASE("a sheet beside a body stays one voxel thick", "[level-set]") {
  const double voxelSize = 0.1;
  const PolygonMesh cube = test::cube();
  PolygonMesh sheet = test::sheet(4, 4);
  for (const double beyond : {1.5, 2.0, 2.5, 3.5}) {
    for (Vec3d& p : sheet.points) p.z() = 0;
    const double top = 1;  // of the smooth cube
    const double height = top + beyond * voxelSize;
    const auto grid = levelSet({cube, test::moved(sheet, Vec3d(-2, -2, height))}, voxelSize);
    CAPTURE(beyond);
    for (const LintFinding& finding : lintGrid(*grid)) {
      CAPTURE(finding.message);
      CHECK(finding.code != "level-set");
    }
    for (auto value = grid->cbeginValueAll(); value; ++value)
      if (worldOf(*grid, value.getCoord()).z() > height - 0.5 * voxelSize)
        REQUIRE(*value >= -0.51F * static_cast<float>(voxelSize));
  }
}

TEST_CASE("plates that touch are one solid, though each is thinner than a voxel", "[level-set]") {
  const auto plate = [](double low, double high) {
    PolygonMesh mesh = test::cube();
    for (Vec3d& p : mesh.points) p = Vec3d(10 * p.x(), 10 * p.y(), p.z() < 0 ? low : high);
    return mesh;
  };
  ConvertOptions options = surfaceAt(1);
  options.until = StopRule{.levels = 0};
  for (const double touch : {-0.2, -0.01, 0.0, 0.01, 0.2}) {
    const auto grid = surfaceOf(convert(
        sceneOf({plate(-0.7, touch), test::moved(plate(touch, 0.9), Vec3d(0.5, 0, 0))}), options));
    CAPTURE(touch);
    for (int x = -8; x <= 8; ++x)
      REQUIRE(valueAt(*grid, Vec3d(x, 0, 0)) == Approx(-0.7).margin(0.02));
  }
}

TEST_CASE("wide bands in unions of polygons know no polygons deep inside", "[level-set]") {
  const PolygonMesh a = test::cube();
  const PolygonMesh b = test::moved(a, Vec3d(1, 0.3, 0));
  const double voxelSize = 0.05;
  ConvertOptions options = surfaceAt(voxelSize);
  options.until = StopRule{.levels = 0};
  options.volume.band = 25;
  const auto grid = surfaceOf(convert(sceneOf({a, b}), options));
  const double kept = 1.7 * voxelSize;  // hidden parts that are this near to the outside are kept
  const double toNotches = std::hypot(0.5, 0.85);  // from the middle
  CHECK(valueAt(*grid, Vec3d(0.5, 0.15, 0)) == Approx(-toNotches).margin(kept));
  CHECK(valueAt(*grid, Vec3d(0, 0, 0.3)) == Approx(-0.7).margin(kept));
  CHECK(valueAt(*grid, Vec3d(1, 0.3, 0.2)) == Approx(-0.8).margin(kept));
}

TEST_CASE("a band of two widths has a background for each side, beside open objects, too",
          "[level-set]") {
  const PolygonMesh solid = test::moved(test::cube(), Vec3d(9, 0, 0), 20);
  for (const auto& meshes : {std::vector{solid}, std::vector{solid, test::sheet(4, 4)}}) {
    for (const BandWidths band : {BandWidths(2, 5), BandWidths(5, 3), BandWidths(2, 22)}) {
      for (const bool isHalf : {false, true}) {
        ConvertOptions options = surfaceAt(0.2);
        options.volume.band = band;
        options.volume.half = isHalf;
        const Conversion conversion = convert(sceneOf(meshes), options);
        const auto grid = surfaceOf(conversion);
        CAPTURE(meshes.size(), band.in, band.out);
        CHECK(grid->background() == Approx(0.2 * band.out));
        CHECK(valueAt(*grid, Vec3d(9, 0, 0)) == Approx(-0.2 * band.in));
        for (auto value = grid->cbeginValueOff(); value; ++value)
          REQUIRE(*value == (*value < 0 ? valueAt(*grid, Vec3d(9, 0, 0)) : grid->background()));
        std::stringstream stream(std::ios::in | std::ios::out | std::ios::binary);
        writeGrids(stream, conversion);
        std::istringstream written(stream.str());
        const auto grids = openvdb::io::Stream(written, false).getGrids();
        CHECK(lintGrid(*grids->at(0)).empty());
      }
    }
  }
}

TEST_CASE("a band of two widths is a fault with other values, or without a record of them",
          "[level-set][lint]") {
  ConvertOptions options = surfaceAt(0.05);
  options.volume.band = BandWidths(4, 3);
  const auto grid = surfaceOf(convert(sceneOf({test::cube()}), options));
  CHECK(lintGrid(*grid).empty());
  const auto faultsWith = [&](auto&& change) {
    const auto changed = grid->deepCopy();
    change(*changed);
    return lintGrid(*changed).size();
  };
  CHECK(faultsWith([](auto& changed) { changed.removeMeta("vox_options"); }) == 1);
  CHECK(faultsWith([](auto& changed) {
          changed.insertMeta("vox_options", openvdb::StringMetadata("band=3,4"));
        }) == 1);
  CHECK(faultsWith([](auto& changed) {
          changed.insertMeta("vox_options", openvdb::StringMetadata("of another program"));
        }) == 1);
  CHECK(faultsWith([](auto& changed) { changed.tree().setValueOff({0, 0, 0}, -0.15F); }) == 1);
  CHECK(faultsWith([](auto& changed) { changed.tree().setValueOn({0, 0, 0}, -0.25F); }) == 1);
}

TEST_CASE("a tolerance has no effect, and a warning says so once", "[level-set]") {
  const auto warningsOf = [](const Scene& scene, const ConvertOptions& options) {
    std::vector<std::string> warnings;
    estimate(scene, options, warnings);
    const Conversion conversion = convert(scene, options);
    CHECK(conversion.report.warnings == warnings);
    return warnings;
  };
  Scene scene = sceneOf({test::cube(), test::moved(test::cube(), Vec3d(9, 0, 0))});
  ConvertOptions options = surfaceAt(0.1);
  CHECK(warningsOf(scene, options).empty());
  options.volume.tolerance = 0.3;
  const std::vector<std::string> warning = {"the tolerance has no effect any more; leave it out"};
  CHECK(warningsOf(scene, options) == warning);
  scene.volume.tolerance = 0.2;
  CHECK(warningsOf(scene, options) == warning);
  options.volume.tolerance = std::nullopt;
  CHECK(warningsOf(scene, options) == warning);
}

TEST_CASE("the polygons of a level have their own level set", "[level-set]") {
  ConvertOptions options = surfaceAt(0.1);
  options.until = StopRule{0};
  const auto grid = surfaceOf(convert(sceneOf({test::cube()}), options));
  CHECK(valueAt(*grid, Vec3d(0.9, 0.9, 0.9)) == Approx(-0.1).margin(1e-5));
  CHECK(valueAt(*grid, Vec3d(0, 1.2, 0)) == Approx(0.2).margin(1e-5));
}

TEST_CASE("a level set is made without voxels, and none are reported", "[level-set]") {
  const Conversion alone = convert(sceneOf({test::cube()}), surfaceAt(0.1));
  CHECK(alone.report.activeVoxels == surfaceOf(alone)->activeVoxelCount());
  CHECK((*alone.grids[0])["vox_options"] != nullptr);
  CHECK((*alone.grids[0])["vox_guarantee"] == nullptr);
  ConvertOptions options = surfaceAt(0.1);
  options.grids = std::vector{GridKind::kSurface, GridKind::kDensity};
  const Conversion both = convert(sceneOf({test::cube()}), options);
  CHECK(both.report.activeVoxels == both.grids[1]->activeVoxelCount());
  CHECK((*both.grids[0])["vox_guarantee"] != nullptr);
}

TEST_CASE("any number of threads makes the same level set", "[level-set][parallel]") {
  const Scene scene = sceneOf({test::torusGrid(24, 12), test::insideOut(test::prism(5)),
                               test::moved(test::sheet(3, 3), Vec3d(0.4, 0, 0))});
  const auto bytes = [&](int threads) {
    ConvertOptions options = surfaceAt(0.03);
    options.run.threads = threads;
    std::stringstream stream(std::ios::in | std::ios::out | std::ios::binary);
    writeGrids(stream, convert(scene, options));
    return stream.str();
  };
  const std::string one = bytes(1);
  for (const int threads : {2, 8, 8}) CHECK(bytes(threads) == one);
}

TEST_CASE("level sets that make no sense or do not fit are refused", "[level-set][error]") {
  for (const double band : {0.5, 1e4, -1.0, std::nan("")}) {
    ConvertOptions options = surfaceAt(0.1);
    options.volume.band = band;
    CHECK_THROWS_AS(convert(sceneOf({test::cube()}), options), UsageError);
  }
  for (const BandWidths band : {BandWidths(0.5, 3), BandWidths(3, 1001), BandWidths(3, -3)}) {
    ConvertOptions options = surfaceAt(0.1);
    options.volume.band = band;
    CHECK_THROWS_AS(convert(sceneOf({test::cube()}), options), UsageError);
  }
  for (const double tolerance : {0.0, 1e-9, 100.0}) {
    ConvertOptions options = surfaceAt(0.1);
    options.volume.tolerance = tolerance;
    CHECK_THROWS_AS(convert(sceneOf({test::cube()}), options), UsageError);
  }
  ConvertOptions options = surfaceAt(0.0005);
  options.run.maxMemory = std::uint64_t{1} << 28;
  CHECK_THROWS_AS(convert(sceneOf({test::cube()}), options), LimitError);
}
