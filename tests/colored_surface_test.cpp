#include "libvox/subdivide/colored_surface.h"

#include "libvox/core/memory.h"
#include "libvox/core/numbered.h"
#include "libvox/core/progress.h"
#include "libvox/grid/active_voxels.h"
#include "libvox/grid/openvdb.h"
#include "libvox/grid/transform.h"
#include "libvox/grid/voxel.h"
#include "libvox/grid/voxel_means.h"
#include "libvox/options/voxelize.h"
#include "libvox/pipeline/convert.h"
#include "libvox/pipeline/surface.h"
#include "libvox/subdivide/doo_sabin.h"
#include "tests/conversion.h"
#include "tests/shapes.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <sstream>
#include <vector>

using namespace vox;
using openvdb::Coord;

namespace {

/// The mesh with colours that are an affine function of the position: 0 to 1 over its box.
PolygonMesh coloredByPlace(PolygonMesh mesh) {
  const Box box = usedBox(mesh);
  const double side = box.longestSide();
  for (const Vec3d& p : mesh.points)
    mesh.pointColors.push_back(((p - box.low) / side).cast<float>());
  return mesh;
}

Conversion convertColor(const PolygonMesh& mesh, const ConvertOptions& more, int dim) {
  Scene scene;
  scene.objects.push_back({"object", mesh});
  ConvertOptions options = more;
  options.dim = dim;
  options.grids = std::vector{GridKind::kColor};
  return convert(scene, options);
}

PolygonMesh squashed(PolygonMesh mesh, double scale) {
  for (Vec3d& p : mesh.points) p = scale * p.cwiseProduct(Vec3d(1, 1.1, 0.9));
  return mesh;
}

class Counter : public ColoredSink {
 public:
  void point(const Vec3d&, const Vec3d&) override { ++count; }
  void patch(const Patch&, const Patch&, std::int64_t rows, std::int64_t columns) override {
    count += rows * columns;
  }
  void curve(const CurvePoints&, const CurvePoints&, std::int64_t more) override { count += more; }
  std::int64_t count = 0;
};

/// Collects vertices in the order of their coordinates.
class Collector : public ColoredSink {
 public:
  void point(const Vec3d& position, const Vec3d& color) override {
    all.push_back({position[0], position[1], position[2], color[0], color[1], color[2]});
  }
  void patch(const Patch& position, const Patch& color, std::int64_t rows,
             std::int64_t columns) override {
    for (std::int64_t i = 0; i < rows; ++i)
      for (std::int64_t j = 0; j < columns; ++j)
        point(at(position, {i, rows}, {j, columns}), at(color, {i, rows}, {j, columns}));
  }
  void curve(const CurvePoints& p, const CurvePoints& c, std::int64_t count) override {
    for (std::int64_t i = 0; i < count; ++i) {
      const PatchWeights weights(i, count);
      point(weights(p[0], p[1], p[2]), weights(c[0], c[1], c[2]));
    }
  }
  std::vector<std::array<double, 6>> sorted() {
    std::sort(all.begin(), all.end());
    return all;
  }
  std::vector<std::array<double, 6>> all;

 private:
  static Vec3d at(const Patch& patch, const PatchWeights& u, const PatchWeights& v) {
    const auto& p = patch.points;
    return v(u(p[0][0], p[1][0], p[2][0]), u(p[0][1], p[1][1], p[2][1]),
             u(p[0][2], p[1][2], p[2][2]));
  }
};

}  // namespace

TEST_CASE("colours that are linear in position stay so on the smooth surface",
          "[color][property]") {
  // Doo-Sabin refines colours with the weights of positions, so an affine function stays affine.
  // The mean of a voxel is over positions at most half a voxel from its centre along each axis.
  std::vector<test::Shape> shapes = test::shapes();
  shapes.insert(shapes.end(), test::openShapes().begin(), test::openShapes().end());
  constexpr int kDim = 21;
  for (const auto& shape : shapes)
    for (const char* boundary : {"extend", "free"})
      for (const char* until : {"voxel", "levels=0", "levels=2"}) {
        if (shape.closed && std::string(boundary) == "free") continue;
        CAPTURE(shape.name, boundary, until);
        ConvertOptions options;
        options.until = stopRuleNamed(until);
        options.smoothing.boundary = namedIn(kBoundaryRuleNames, boundary);
        const Conversion conversion = convertColor(coloredByPlace(shape.mesh), options, kDim);
        const Vec3d low = usedBox(shape.mesh).low / conversion.report.voxelSize;
        double furthest = 0;
        std::size_t far = 0;
        for (auto voxel = test::colorOf(conversion).cbeginValueOn(); voxel; ++voxel) {
          const Coord at = voxel.getCoord();
          const Vec3d expected = (Vec3d(at.x(), at.y(), at.z()) - low) / kDim;
          const Vec3d found(voxel->x(), voxel->y(), voxel->z());
          const double off =
              (found - expected.cwiseMax(0).cwiseMin(1)).cwiseAbs().maxCoeff() * kDim;
          far += off > 0.501;
          furthest = std::max(furthest, off);
        }
        // Voxels without a sample have the mean of their neighbours' means. There are few of them
        // along a boundary, where vertex conversion goes deeper than it must, and more where
        // polygons only graze voxels.
        const bool sampled = std::string(until) == "voxel";
        CHECK(furthest < 1.6);
        CHECK(far <= test::colorOf(conversion).activeVoxelCount() / (sampled ? 10 : 5));
      }
}

TEST_CASE("the middle of a face keeps the face's colour", "[color][golden]") {
  PolygonMesh cube = test::cube();
  for (int f = 0; f < 6; ++f)
    cube.faceColors.push_back(Vec3d(f / 5.0, 1 - f / 5.0, 0.5).cast<float>());
  const Conversion conversion = convertColor(cube, {}, 200);
  for (Index f = 0; f < 6; ++f) {
    // The surface touches the middles of the cube's faces, flat.
    const Vec3d centre = test::faceCentroid(cube, f) / conversion.report.voxelSize;
    const auto found =
        test::colorOf(conversion)
            .tree()
            .getValue(Coord(static_cast<int>(centre.x()), static_cast<int>(centre.y()),
                            static_cast<int>(centre.z())));
    CAPTURE(f);
    CHECK(found.x() == Approx(f / 5.0).margin(0.01));
    CHECK(found.y() == Approx(1 - f / 5.0).margin(0.01));
    CHECK(found.z() == Approx(0.5).margin(1e-5));
  }
}

TEST_CASE("the colours of points come before those of faces", "[color]") {
  PolygonMesh cube = test::cube();
  cube.pointColors.assign(8, Vec3f(0, 1, 0));
  cube.faceColors.assign(6, Vec3f(1, 0, 0));
  const Conversion conversion = convertColor(cube, {}, 20);
  for (auto voxel = test::colorOf(conversion).cbeginValueOn(); voxel; ++voxel)
    CHECK(*voxel == openvdb::Vec3f(0, 1, 0));
}

TEST_CASE("vertices and colours have the same bits for any partition of the mesh",
          "[color][property]") {
  std::vector<test::Shape> shapes = test::shapes();
  shapes.insert(shapes.end(), test::openShapes().begin(), test::openShapes().end());
  for (const auto& shape : shapes)
    for (const BoundaryRule rule : {BoundaryRule::kExtend, BoundaryRule::kFree}) {
      CAPTURE(shape.name);
      const PolygonMesh mesh = squashed(coloredByPlace(shape.mesh), 4);
      const SubdivisionLevel base = baseLevel(mesh, rule);
      const std::vector<Vec3d> colors = cornerColors(mesh);
      Collector whole, parts;
      std::vector<Index> all;
      for (Index f = 0; f < mesh.faceCount(); ++f) all.push_back(f);
      ColoredSurface(base, colors).emit(all, whole);
      ColoredSurface surface(base, colors);
      for (const Index f : all) surface.emit(std::array{f}, parts);
      CHECK(whole.all.size() >= mesh.cornerCount());
      CHECK(whole.sorted() == parts.sorted());
    }
}

TEST_CASE(
    "around a face of many sides, samples reach all voxels with the colours of their positions",
    "[color][property]") {
  for (const PolygonMesh& shape : {test::prism(300), test::pyramid(300)}) {
    const PolygonMesh mesh = coloredByPlace(squashed(shape, 40));
    const Box box = usedBox(mesh);
    const SubdivisionLevel base = baseLevel(mesh);
    ActiveVoxels grid;
    SurfaceReport report;
    Progress progress;
    markSurface(base, {}, MemoryBudget(0), progress, grid, report);
    const auto voxels = grid.takeTree();

    Collector samples;
    ColoredSurface(base, cornerColors(mesh)).emit(numbered(mesh.faceCount()), samples);
    openvdb::MaskTree reached;
    double off = 0;
    for (const auto& [x, y, z, r, g, b] : samples.all) {
      const Vec3d at(x, y, z);
      reached.setValueOn(voxelOf(at));
      const Vec3d place = (at - box.low) / box.longestSide();
      off = std::max(off, (place - Vec3d(r, g, b)).cwiseAbs().maxCoeff());
    }
    CHECK(off < 1e-6);  // points have colours of single precision
    std::size_t missed = 0;
    for (auto voxel = voxels->cbeginValueOn(); voxel; ++voxel)
      missed += !reached.isValueOn(voxel.getCoord());
    CHECK(missed < voxels->activeVoxelCount() / 50);
  }
}

TEST_CASE(
    "if rows and columns run the same way, samples grow with their length, not with its square",
    "[color][property]") {
  const auto samplesAt = [](double scale) {
    PolygonMesh mesh = coloredByPlace(test::sheet(6, 6));
    for (Vec3d& p : mesh.points) p = scale * Vec3d(p.x() + p.y(), 0.01 * p.y(), 0.01 * p.z());
    Counter samples;
    ColoredSurface(baseLevel(mesh), cornerColors(mesh)).emit(numbered(mesh.faceCount()), samples);
    return static_cast<double>(samples.count);
  };
  CHECK(samplesAt(40) < 2.5 * samplesAt(20));  // full arrays would have 4 times as many
}

TEST_CASE("colours around a face of thousands of edges stay within the memory", "[color][error]") {
  const PolygonMesh prism = coloredByPlace(test::prism(5000));
  ConvertOptions options;
  options.voxelize = Voxelize::kVertex;
  options.run.maxMemory = std::uint64_t{1} << 26;
  CHECK_THROWS_WITH(convertColor(prism, options, 16), Catch::Contains("5000 faces or edges"));
  options.run.maxMemory = std::uint64_t{1} << 30;
  CHECK_NOTHROW(convertColor(prism, options, 16));
}

TEST_CASE("a coloured mesh gives the same bytes for any number of threads", "[color][parallel]") {
  const auto bytes = [](int threads) {
    ConvertOptions options;
    options.run.threads = threads;
    const Conversion conversion = convertColor(coloredByPlace(test::torusGrid(12, 6)), options, 60);
    std::stringstream stream(std::ios::in | std::ios::out | std::ios::binary);
    writeGrids(stream, conversion);
    return stream.str();
  };
  CHECK(bytes(1) == bytes(8));
}

TEST_CASE("a voxel has the mean of its samples, or that of its neighbours", "[color]") {
  openvdb::MaskTree voxels;
  for (const Coord& voxel : {Coord(7, 0, 0), Coord(8, 0, 0), Coord(9, 1, 0), Coord(40, 0, 0)})
    voxels.setValueOn(voxel);
  VoxelMeans means(voxels);
  VoxelMeans::Writer writer(means);
  writer.add({7, 0, 0}, Vec3d(1, 0, 0.25));
  writer.add({7, 0, 0}, Vec3d(0, 1, 0.25));
  writer.add({7, 0, 0}, Vec3d(9, -9, 0.25));  // clamped
  writer.add({7, 5, 0}, Vec3d(0, 1, 0));      // no active voxel
  writer.add({1000, 5, 0}, Vec3d(0, 1, 0));
  means.fillGaps();
  const Vec3d mean(2.0 / 3, 0, 0.25);
  constexpr double kRounding = 3.0 / (1 << 30);  // one for each sample and each neighbour
  CHECK((*means.meanOf({7, 0, 0}) - mean).norm() < kRounding);
  CHECK((*means.meanOf({8, 0, 0}) - mean).norm() < kRounding);
  CHECK((*means.meanOf({9, 1, 0}) - mean).norm() < kRounding);
  CHECK_FALSE(means.meanOf({40, 0, 0}));
  CHECK_FALSE(means.meanOf({7, 5, 0}));
}
