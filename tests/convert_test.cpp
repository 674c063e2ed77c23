#include "libvox/pipeline/convert.h"

#include "libvox/core/error.h"
#include "libvox/core/progress.h"
#include "libvox/grid/openvdb.h"
#include "libvox/io/read_vdb.h"
#include "libvox/subdivide/doo_sabin.h"
#include "tests/conversion.h"
#include "tests/reference.h"
#include "tests/scenes.h"
#include "tests/shapes.h"
#include "tests/temporary_folder.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <sstream>
#include <string>
#include <vector>

using namespace vox;
using Catch::Contains;
using openvdb::Coord;

namespace {

ConvertOptions maskAt(int dim) {
  ConvertOptions options;
  options.dim = dim;
  options.grids = std::vector{GridKind::kMask};
  return options;
}

/// The mesh whose vertices were converted, in index space.
PolygonMesh refinedIndex(const PolygonMesh& mesh, const Conversion& conversion) {
  PolygonMesh refined = subdivide(baseLevel(mesh), conversion.report.objects[0].levels).mesh;
  for (Vec3d& p : refined.points) p /= conversion.report.voxelSize;
  return refined;
}

/// Whether a path of inactive voxels, face to face, leads from one voxel to another within a box.
bool inactivePath(const openvdb::MaskGrid& mask, const openvdb::CoordBBox& box, Coord from,
                  Coord to) {
  openvdb::MaskTree reached;
  std::vector<Coord> open = {from};
  reached.setValueOn(from);
  while (!open.empty()) {
    const Coord at = open.back();
    open.pop_back();
    if (at == to) return true;
    for (int axis = 0; axis < 3; ++axis)
      for (const int step : {-1, 1}) {
        Coord next = at;
        next[axis] += step;
        if (!box.isInside(next) || mask.tree().isValueOn(next) || reached.isValueOn(next)) continue;
        reached.setValueOn(next);
        open.push_back(next);
      }
  }
  return false;
}

}  // namespace

TEST_CASE("no path of inactive voxels joins the sides of a closed surface",
          "[pipeline][property]") {
  for (const auto& shape : test::shapes())
    for (const int dim : {8, 13}) {
      if (!shape.closed) continue;
      CAPTURE(shape.name, dim);
      const Conversion conversion = convert(test::oneObject(shape.mesh), maskAt(dim));
      const test::Sides sides =
          test::sidesOf(refinedIndex(shape.mesh, conversion), test::maskOf(conversion));
      CHECK(sides.outside > 0);
      CHECK((sides.inside > 0 || dim < 13));
      CHECK(sides.leaks == 0);
    }
}

TEST_CASE("no path of inactive voxels joins the sides of a long thin bar", "[pipeline][property]") {
  // Its patches are emitted as rows, which must separate at any angle.
  for (const double angle : {0.0, 0.3, 0.7853981633974483}) {
    CAPTURE(angle);
    PolygonMesh bar = test::cube();
    for (Vec3d& p : bar.points)
      p = Vec3d(12 * p.x() * std::cos(angle) - p.y() * std::sin(angle),
                12 * p.x() * std::sin(angle) + p.y() * std::cos(angle), p.z());
    const Conversion conversion = convert(test::oneObject(bar), maskAt(45));
    constexpr int kLevels = 4;  // within 0.1 voxels of the surface
    PolygonMesh surface = subdivide(baseLevel(bar), kLevels).mesh;
    for (Vec3d& p : surface.points) p /= conversion.report.voxelSize;
    const test::Sides sides = test::sidesOf(surface, test::maskOf(conversion));
    CHECK(sides.outside > 0);
    CHECK(sides.inside > 0);
    CHECK(sides.leaks == 0);
  }
}

TEST_CASE("a needle needs few vertices and loses no voxels", "[pipeline]") {
  const PolygonMesh needle = test::meshOf({{0, 0, 0}, {1, 0, 0}, {0.5, 0.8, 0}, {0.5, 0.3, 4000}},
                                          {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}});
  ConvertOptions options;
  options.dim = 3000;
  const Conversion conversion = convert(test::oneObject(needle), options);
  const ObjectReport& part = conversion.report.objects[0];
  CHECK(part.vertices < 150 * part.activeVoxels);
  // A smoothed tetrahedron keeps more than half of its length.
  CHECK(part.activeVoxels > 1500);
}

TEST_CASE("removing a voxel that the surface needs opens a leak that the check sees",
          "[pipeline]") {
  const PolygonMesh shape = test::dodecahedron();
  const Conversion conversion = convert(test::oneObject(shape), maskAt(9));
  const PolygonMesh refined = refinedIndex(shape, conversion);
  const openvdb::MaskGrid& mask = test::maskOf(conversion);
  std::size_t tried = 0;
  std::size_t opened = 0;
  for (auto voxel = mask.cbeginValueOn(); voxel; ++voxel) {
    if (++tried % 7 != 0) continue;
    const openvdb::MaskGrid::Ptr holed = mask.deepCopy();
    holed->tree().setValueOff(voxel.getCoord());
    opened += test::sidesOf(refined, *holed).leaks > 0;
  }
  CHECK(opened > tried / 7 / 4);
}

TEST_CASE("an open sheet has no hole from one side to the other", "[pipeline][property]") {
  const BoundaryRule rule = GENERATE(BoundaryRule::kFree, BoundaryRule::kExtend);
  ConvertOptions options = maskAt(40);
  options.smoothing.boundary = rule;
  const Conversion conversion = convert(test::oneObject(test::sheet(5, 4)), options);
  // Plain Doo-Sabin ends half a face inside the boundary; only columns within are checked.
  const double unit = 1 / conversion.report.voxelSize;
  const auto at = [&](double x) { return static_cast<int>(x * unit); };
  const openvdb::CoordBBox box(at(1), at(1), at(-1), at(4), at(3), at(1));
  CHECK_FALSE(inactivePath(test::maskOf(conversion), box, box.min(), box.max()));
}

TEST_CASE("inactive voxels inside and outside a closed surface are not connected",
          "[pipeline][property]") {
  for (const auto& mesh : {test::cube(), test::dodecahedron(), test::prism(12)}) {
    const Conversion conversion = convert(test::oneObject(mesh), maskAt(40));
    openvdb::CoordBBox box = test::maskOf(conversion).evalActiveVoxelBoundingBox();
    box.expand(1);
    CHECK_FALSE(test::maskOf(conversion).tree().isValueOn({0, 0, 0}));
    CHECK_FALSE(inactivePath(test::maskOf(conversion), box, box.min(), {0, 0, 0}));
    CHECK(inactivePath(test::maskOf(conversion), box, box.min(), box.max()));
  }
}

TEST_CASE("a smoothed cube passes through the centres of its faces", "[pipeline][golden]") {
  const Conversion conversion = convert(test::oneObject(test::cube()), maskAt(64));
  CHECK(conversion.report.voxelSize == 2.0 / 64);
  for (int axis = 0; axis < 3; ++axis)
    for (const int end : {-32, 32}) {
      Coord centre(0, 0, 0);
      centre[axis] = end;
      CHECK(test::maskOf(conversion).tree().isValueOn(centre));
    }
  CHECK_FALSE(test::maskOf(conversion).tree().isValueOn({32, 32, 32}));
}

TEST_CASE("objects of a scene share one grid", "[pipeline]") {
  PolygonMesh far = test::cube();
  for (Vec3d& p : far.points) p.x() += 10;
  Scene both = test::oneObject(test::cube());
  both.objects.push_back({"far", far});
  ConvertOptions options = maskAt(1);
  options.dim.reset();
  options.voxelSize = 0.125;
  const auto near = convert(test::oneObject(test::cube()), options).report.activeVoxels;
  const Conversion conversion = convert(both, options);
  CHECK(conversion.report.activeVoxels == 2 * near);
  CHECK(test::maskOf(conversion).tree().isValueOn({8, 0, 0}));
  CHECK(test::maskOf(conversion).tree().isValueOn({88, 0, 0}));
}

TEST_CASE("options come before the scene, the scene before the defaults", "[pipeline]") {
  Scene scene = test::oneObject(test::cube());
  CHECK(convert(scene, {}).report.voxelSize == 2.0 / kDefaultDim);
  scene.voxelSize = 0.5;
  scene.grids = std::vector{GridKind::kMask};
  CHECK(convert(scene, {}).report.voxelSize == 0.5);
  CHECK(convert(scene, {}).grids.at(0)->getName() == "mask");
  const Conversion conversion = convert(scene, maskAt(10));
  CHECK(conversion.report.voxelSize == 0.2);
}

TEST_CASE("two runs, and any number of threads, give the same bytes", "[pipeline][parallel]") {
  Scene scene = test::oneObject(test::shuffled(test::torusGrid(24, 12), 5));
  scene.objects.push_back({"more", test::prism(9)});
  ConvertOptions options;
  options.dim = 200;
  options.grids = std::vector{GridKind::kDensity, GridKind::kMask};
  const std::string first = test::bytesOf(convert(scene, options));
  for (const int threads : {1, 2, 8}) {
    options.run.threads = threads;
    CHECK(test::bytesOf(convert(scene, options)) == first);
  }
}

TEST_CASE("any number of threads gives the same bytes where patches are split",
          "[pipeline][parallel]") {
  ConvertOptions options = maskAt(1200);
  const std::string first = test::bytesOf(convert(test::oneObject(test::cube()), options));
  for (const int threads : {1, 2, 8}) {
    options.run.threads = threads;
    CHECK(test::bytesOf(convert(test::oneObject(test::cube()), options)) == first);
  }
}

TEST_CASE("a conversion moves through its stages from 0 to 1, and writing is the last",
          "[pipeline]") {
  const test::TemporaryFolder folder;
  Scene scene = test::oneObject(test::torusGrid(24, 12));
  scene.objects.push_back({"more", test::prism(9)});
  ConvertOptions options = maskAt(300);
  options.grids = std::vector{GridKind::kDensity, GridKind::kMask};
  for (const int threads : {1, 8}) {
    std::vector<double> fractions;
    std::vector<std::string> stages;
    Progress progress(
        [&](double fraction, const char* stage) {
          fractions.push_back(fraction);
          if (stages.empty() || stages.back() != stage) stages.emplace_back(stage);
        },
        std::chrono::nanoseconds(0));
    options.run.threads = threads;
    options.run.progress = &progress;
    const Conversion conversion = convert(scene, options);
    CHECK(fractions.back() < 1);
    writeGrids(folder / "out.vdb", conversion, true, &progress);
    progress.finish();
    CHECK(stages == std::vector<std::string>{"prepare", "surface", "grids", "write"});
    CHECK(fractions.front() == 0);
    CHECK(std::is_sorted(fractions.begin(), fractions.end()));
    CHECK(fractions.back() == 1);
    CHECK(fractions.size() > 10);
  }
}

TEST_CASE("a conversion that is watched writes the same bytes", "[pipeline]") {
  Progress progress([](double, const char*) {}, std::chrono::nanoseconds(0));
  ConvertOptions options = maskAt(100);
  const std::string unwatched = test::bytesOf(convert(test::oneObject(test::cube()), options));
  options.run.progress = &progress;
  const Conversion conversion = convert(test::oneObject(test::cube()), options);
  std::stringstream stream(std::ios::in | std::ios::out | std::ios::binary);
  writeGrids(stream, conversion, &progress);
  CHECK(stream.str() == unwatched);
}

TEST_CASE("a conversion can be cancelled in each of its stages, and leaves nothing", "[pipeline]") {
  const test::TemporaryFolder folder;
  for (const std::string when : {"prepare", "surface", "grids", "write"})
    for (const auto localize : {Localize::kDuring, Localize::kOff}) {
      CAPTURE(when, nameIn(kLocalizeNames, localize));
      Progress* run = nullptr;
      std::string last;
      Progress progress(
          [&](double, const char* stage) {
            last = stage;
            if (stage == when) run->cancel();
          },
          std::chrono::nanoseconds(0));
      run = &progress;
      ConvertOptions options;
      options.dim = 100;
      options.surface.localize = localize;
      options.run.progress = &progress;
      const auto work = [&] {
        writeGrids(folder / "out.vdb", convert(test::oneObject(test::cube()), options), false,
                   &progress);
      };
      CHECK_THROWS_AS(work(), Cancelled);
      CHECK(last == when);
      CHECK(folder.fileCount() == 0);
    }
}

TEST_CASE("the numbers of a report add up", "[pipeline]") {
  Scene scene = test::oneObject(test::cube());
  scene.objects.push_back({"the same", test::cube()});
  scene.objects.push_back({"another", test::dodecahedron()});
  ConvertOptions options = maskAt(60);
  options.run.threads = 2;
  const Conversion conversion = convert(scene, options);
  const ConvertReport& report = conversion.report;
  CHECK(report.activeVoxels == test::maskOf(conversion).activeVoxelCount());
  CHECK(report.threads == 2);
  std::uint64_t voxels = 0;
  for (const ObjectReport& object : report.objects) {
    voxels += object.activeVoxels;
    const LevelCounts& levels = object.verticesOfLevel;
    CHECK(object.vertices == std::accumulate(levels.begin(), levels.end(), std::uint64_t{0}));
    CHECK(levels[static_cast<std::size_t>(object.levels)] > 0);
    CHECK(object.submeshes == 1);
  }
  CHECK(voxels == report.activeVoxels);
  CHECK(report.objects[0].activeVoxels > 0);
  CHECK(report.objects[1].activeVoxels == 0);
  CHECK(report.objects[2].activeVoxels > 0);
  CHECK(report.objects[1].vertices == report.objects[0].vertices);
}

TEST_CASE("a conversion that cannot fit is refused before it starts", "[pipeline][error]") {
  ConvertOptions options = maskAt(100000);
  options.run.maxMemory = std::uint64_t{1} << 28;
  CHECK_THROWS_AS(convert(test::oneObject(test::cube()), options), LimitError);
  CHECK_THROWS_WITH(convert(test::oneObject(test::cube()), options),
                    Contains("limit is 256.0 MiB") && Contains("--voxel-size"));
}

TEST_CASE("impossible requests are refused", "[pipeline][error]") {
  CHECK_THROWS_AS(convert(test::oneObject(test::cube()), maskAt(0)), UsageError);
  ConvertOptions fine;
  fine.voxelSize = 1e-12;
  CHECK_THROWS_AS(convert(test::oneObject(test::cube()), fine), LimitError);
}

TEST_CASE("a small mesh scattered over much space is refused before it fills the memory",
          "[pipeline][error]") {
  PolygonMesh scattered;
  for (Index i = 0; i < 2000; ++i) {
    const Vec3d at = 1e5 * Vec3d(i % 13, i % 17, i % 29);
    for (const Vec3d& corner : {Vec3d(0, 0, 0), Vec3d(0.4, 0, 0), Vec3d(0, 0.4, 0)})
      scattered.points.push_back(at + corner);
    scattered.addFace(std::vector<Index>{3 * i, 3 * i + 1, 3 * i + 2});
  }
  ConvertOptions options;
  options.voxelSize = 1;
  options.run.maxMemory = std::uint64_t{1} << 26;
  CHECK_THROWS_WITH(convert(test::oneObject(scattered), options), Contains("scattered"));
}

TEST_CASE("the resolution that a refusal advises works", "[pipeline][error]") {
  for (const auto& shape : test::shapes()) {
    CAPTURE(shape.name);
    ConvertOptions options = maskAt(4000);
    options.run.maxMemory = std::uint64_t{1} << 23;
    try {
      convert(test::oneObject(shape.mesh), options);
      FAIL("fits");
    } catch (const LimitError& error) {
      const std::string message = error.what();
      CAPTURE(message);
      const std::string key = "--dim ";
      options.dim = std::stoi(message.substr(message.find(key) + key.size()));
      CHECK(*options.dim > 20);
      CHECK_NOTHROW(convert(test::oneObject(shape.mesh), options));
    }
  }
}

TEST_CASE("an open mesh is converted with a warning if it may shrink", "[pipeline]") {
  CHECK(convert(test::oneObject(test::cube()), maskAt(8)).report.warnings.empty());
  CHECK(convert(test::oneObject(test::sheet(3, 3)), maskAt(8)).report.warnings.empty());
  ConvertOptions options = maskAt(8);
  options.smoothing.boundary = BoundaryRule::kFree;
  const auto warnings = convert(test::oneObject(test::sheet(3, 3)), options).report.warnings;
  REQUIRE(warnings.size() == 1);
  CHECK_THAT(warnings[0], Contains("object is open: it has 1 boundary loop"));
}

TEST_CASE("an interpolating surface passes through the corners of the cube", "[pipeline]") {
  ConvertOptions options = maskAt(64);
  options.smoothing.interpolate = Interpolate::kInterior;
  const Conversion conversion = convert(test::oneObject(test::cube()), options);
  // The vertices around the interpolated point lie within a voxel of it.
  const auto reaches = [&](int x, int y, int z) {
    const openvdb::Coord at(x, y, z);
    const openvdb::CoordBBox box(at.offsetBy(-1), at.offsetBy(1));
    openvdb::MaskTree near(test::maskOf(conversion).tree());
    near.clip(box);
    return !near.empty();
  };
  CHECK(reaches(32, 32, 32));
  CHECK(reaches(-32, 32, -32));
  CHECK_FALSE(reaches(32, 32, 0));
  CHECK(conversion.report.objects[0].interpolation.lift.vertices == 8);
}

TEST_CASE("an extended sheet reaches its boundary, and its corners if interpolated", "[pipeline]") {
  PolygonMesh flat = test::sheet(4, 4);
  for (Vec3d& p : flat.points) p.z() = 0;
  ConvertOptions options = maskAt(40);
  const auto isOn = [&](int i, int j) {
    return test::maskOf(convert(test::oneObject(flat), options)).tree().isValueOn({i, j, 0});
  };
  CHECK(isOn(20, 0));
  CHECK_FALSE(isOn(0, 0));
  options.smoothing.interpolate = Interpolate::kBoundary;
  CHECK(isOn(0, 0));
  CHECK(isOn(40, 40));
}

TEST_CASE("contradictory arrays are refused", "[pipeline][error]") {
  PolygonMesh mesh = test::cube();
  mesh.faceVertices[5] = 50000000;
  CHECK_THROWS_AS(convert(test::oneObject(mesh), maskAt(8)), MeshError);
}

TEST_CASE("flipping any faces changes no voxel", "[pipeline][property]") {
  std::vector<test::Shape> all = test::shapes();
  all.insert(all.end(), test::openShapes().begin(), test::openShapes().end());
  all.push_back({"Moebius strip", test::moebius(9), false});
  all.push_back({"Klein bottle", test::klein(9, 6), true});
  all.push_back({"fin", test::finOnSheet(), false});
  all.push_back({"book", test::book(5), false});
  all.push_back({"cones", test::twoCones(), false});
  for (const auto& shape : all) {
    CAPTURE(shape.name);
    const Conversion plain = convert(test::oneObject(shape.mesh), maskAt(20));
    for (const std::uint32_t seed : {1U, 2U, 3U}) {
      const Conversion other =
          convert(test::oneObject(test::stirred(shape.mesh, 0.5, seed)), maskAt(20));
      CHECK(test::maskOf(other).tree().hasSameTopology(test::maskOf(plain).tree()));
    }
  }
}

TEST_CASE("a Moebius strip is converted with a warning", "[pipeline]") {
  const Conversion conversion = convert(test::oneObject(test::moebius(12)), maskAt(60));
  CHECK(conversion.report.activeVoxels > 1000);
  REQUIRE_FALSE(conversion.report.warnings.empty());
  CHECK_THAT(conversion.report.warnings[0], Contains("one-sided"));
}

TEST_CASE("a conversion reports repairs in one line", "[pipeline]") {
  const PolygonMesh cube = test::cube();
  const Conversion conversion = convert(test::oneObject(test::unwelded(cube)), maskAt(30));
  REQUIRE(conversion.report.warnings.size() == 1);
  CHECK_THAT(conversion.report.warnings[0], Contains("welded 16 vertices"));
  const Conversion plain = convert(test::oneObject(cube), maskAt(30));
  CHECK(test::maskOf(conversion).tree().hasSameTopology(test::maskOf(plain).tree()));
}

TEST_CASE("the weld tolerance is in world units, whatever the resolution", "[pipeline]") {
  PolygonMesh gaping = test::unwelded(test::cube());
  for (Index v = 0; v < gaping.pointCount(); ++v)
    gaping.points[v] += 0.001 * (v / 4) * Vec3d::Ones();
  for (const int dim : {4, 400}) {  // voxels of 1/2 and of 1/200
    ConvertOptions options = maskAt(dim);
    options.weldTolerance = 0.01;
    const Conversion conversion = convert(test::oneObject(gaping), options);
    REQUIRE(conversion.report.warnings.size() == 1);
    CHECK_THAT(conversion.report.warnings[0], Contains("welded 16 vertices"));
    CHECK(conversion.grids[0]->metaValue<std::string>("vox_options").find(" weld=0.01") !=
          std::string::npos);
    options.weldTolerance = 0.0001;
    const auto warnings = convert(test::oneObject(gaping), options).report.warnings;
    REQUIRE(warnings.size() == 1);
    CHECK_THAT(warnings[0], Contains("falls apart into 6 separate faces") && Contains("--weld"));
  }
}

TEST_CASE("no value is lost that 16 bits cannot hold", "[pipeline]") {
  const test::TemporaryFolder folder;
  const double scale = GENERATE(1.6e-4, 1.0, 1e7);
  PolygonMesh mesh = test::cube();
  for (Vec3d& p : mesh.points) p *= scale;
  ConvertOptions options = maskAt(20);
  options.grids = std::vector{GridKind::kSurface, GridKind::kDensity, GridKind::kNormal};
  options.volume.half = true;
  const Conversion conversion = convert(test::oneObject(mesh), options);
  writeGrids(folder / "half.vdb", conversion, false);
  const VdbFile file = readVdb(folder / "half.vdb");
  const auto gridOf = [&](const std::string& name) {
    return std::find_if(file.grids.begin(), file.grids.end(),
                        [&](const NamedGrid& grid) { return grid.name == name; })
        ->grid;
  };
  const double voxelSize = conversion.report.voxelSize;
  const auto& made = dynamic_cast<const openvdb::FloatGrid&>(*conversion.grids[0]);
  const auto& read = dynamic_cast<const openvdb::FloatGrid&>(*gridOf("surface"));
  CHECK(std::abs(made.background() - read.background()) < 0.002 * voxelSize);
  double most = 0;
  for (auto value = made.cbeginValueOn(); value; ++value)
    most = std::max(most, std::abs(double{*value} - read.tree().getValue(value.getCoord())));
  CHECK(most < 0.002 * voxelSize);
  CHECK((most == 0) == (scale != 1));
  const auto& density = dynamic_cast<const openvdb::FloatGrid&>(*gridOf("density"));
  const double full = conversion.grids[1]->metaValue<float>("vox_gain");
  CHECK(density.cbeginValueOn().getValue() == Approx(full).epsilon(0.001));
  CHECK(gridOf("normal")->saveFloatAsHalf());
  std::vector<std::string> kept;
  for (const std::string& warning : conversion.report.warnings)
    if (warning.find("32 bits") != std::string::npos) kept.push_back(warning);
  CHECK(kept.size() == (scale == 1 ? 0 : 1));  // surface
}

TEST_CASE("strict conversion takes a sound mesh and refuses any other", "[pipeline][error]") {
  ConvertOptions options = maskAt(8);
  options.strict = true;
  CHECK(convert(test::oneObject(test::cube()), options).report.warnings.empty());
  CHECK_THROWS_AS(convert(test::oneObject(test::moebius(8)), options), MeshError);
}
