// Densities with soft edges, from mesh to grid.

#include "libvox/core/numbered.h"
#include "libvox/grid/openvdb.h"
#include "libvox/grid/transform.h"
#include "libvox/mesh/area.h"
#include "libvox/pipeline/convert.h"
#include "libvox/prepare/enclosure.h"
#include "libvox/subdivide/doo_sabin.h"
#include "libvox/volume/texture.h"
#include "tests/conversion.h"
#include "tests/scenes.h"
#include "tests/shapes.h"
#include "tests/spline_torus.h"

#include <catch2/catch.hpp>
#include <openvdb/tools/Interpolation.h>
#include <openvdb/tools/Morphology.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

using namespace vox;
using openvdb::Coord;

namespace {

ConvertOptions softOptions(Fill fill, double voxelSize) {
  ConvertOptions options;
  options.voxelSize = voxelSize;
  options.volume.fill = fill;
  options.volume.edge = Edge::kSoft;
  options.volume.gain = 1;
  return options;
}

openvdb::FloatGrid::Ptr softDensity(const Scene& scene, const ConvertOptions& options) {
  return openvdb::gridPtrCast<openvdb::FloatGrid>(convert(scene, options).grids[0]);
}

double voxelSizeFor(const PolygonMesh& mesh, int dim) {
  return usedBox(mesh).longestSide() / dim;
}

/// Sum of the values of all voxels, in world units of volume.
double volumeOf(const openvdb::FloatGrid& density) {
  double sum = 0;
  for (auto value = density.cbeginValueOn(); value; ++value)
    sum += double{*value} * static_cast<double>(value.getVoxelCount());
  const double size = density.voxelSize()[0];
  return sum * size * size * size;
}

/// A mesh close to the limit surface: some steps, then by Richardson exact to the next order.
struct Measures {
  double volume, area;
};
Measures limitMeasures(const PolygonMesh& mesh) {
  const auto at = [&](int levels) {
    const PolygonMesh fine = subdivide(baseLevel(mesh), levels).mesh;
    return Measures{signedVolume(fine, numbered(fine.faceCount())).volume, areaOf(fine)};
  };
  const Measures coarse = at(5);
  const Measures fine = at(6);
  return {fine.volume + (fine.volume - coarse.volume) / 3,
          fine.area + (fine.area - coarse.area) / 3};
}

struct Difference {
  double rms, most;
};
/// Compares soft values with the part of a voxel that is inside according to a finer level set.
/// @param fine  times as many voxels
Difference differenceFrom(const openvdb::FloatGrid& density, const openvdb::FloatGrid& distance,
                          int fine) {
  double sum = 0;
  double most = 0;
  int count = 0;
  const openvdb::tools::GridSampler<openvdb::FloatGrid, openvdb::tools::BoxSampler> at(distance);
  const double size = density.voxelSize()[0];
  for (auto voxel = density.cbeginValueOn(); voxel; ++voxel) {
    if (!voxel.isVoxelValue()) continue;
    double part = 0;
    const openvdb::Vec3d middle = voxel.getCoord().asVec3d() * size;
    if (std::abs(at.wsSample(middle)) > size) continue;
    for (int x = 0; x < fine; ++x)
      for (int y = 0; y < fine; ++y)
        for (int z = 0; z < fine; ++z) {
          const openvdb::Vec3d step(x, y, z);
          const openvdb::Vec3d p = middle + ((step + 0.5) / fine - 0.5) * size;
          // Blurred over a sub-cube.
          part += std::clamp(0.5 - at.wsSample(p) / size * fine, 0.0, 1.0);
        }
    const double error = double{*voxel} - part / (fine * fine * fine);
    sum += error * error;
    most = std::max(most, std::abs(error));
    ++count;
  }
  return {std::sqrt(sum / count), most};
}

}  // namespace

TEST_CASE("a soft solid has the volume inside its surface", "[soft][golden]") {
  const test::SplineTorus torus(12, 8);
  for (const double size : {1.0 / 20, 1.0 / 40, 1.0 / 80}) {
    const double volume = volumeOf(
        *softDensity(test::oneObject(test::torusGrid(12, 8)), softOptions(Fill::kSolid, size)));
    CAPTURE(size, volume / torus.volume() - 1);
    CHECK(volume == Approx(torus.volume()).epsilon(size * size));
  }
  for (const auto& shape : test::shapes()) {
    if (!shape.closed || shape.name == "point of valence 2") continue;  // which is repaired
    CAPTURE(shape.name);
    const Measures limit = limitMeasures(shape.mesh);
    const double size = voxelSizeFor(shape.mesh, 160);
    const double volume =
        volumeOf(*softDensity(test::oneObject(shape.mesh), softOptions(Fill::kSolid, size)));
    CAPTURE(volume, limit.volume);
    CHECK(volume == Approx(limit.volume).epsilon(1e-3));
  }
}

TEST_CASE("a soft shell has the volume of its surface, a voxel thick", "[soft][golden]") {
  for (const auto& shape : test::shapes()) {
    if (!shape.closed || shape.name == "point of valence 2") continue;
    CAPTURE(shape.name);
    const Measures limit = limitMeasures(shape.mesh);
    const double size = voxelSizeFor(shape.mesh, 160);
    const double volume =
        volumeOf(*softDensity(test::oneObject(shape.mesh), softOptions(Fill::kSurface, size)));
    CAPTURE(volume / size, limit.area);
    CHECK(volume / size == Approx(limit.area).epsilon(0.01));
  }
}

TEST_CASE("each soft value is the part of the voxel inside", "[soft][property]") {
  constexpr int kFine = 4;
  const PolygonMesh one = test::dodecahedron();
  const std::vector<PolygonMesh> meshes = {one, test::torusGrid(9, 6),
                                           test::together(one, one, Vec3d(0.5, 0.3, 0.2))};
  for (const PolygonMesh& mesh : meshes) {
    ConvertOptions options = softOptions(Fill::kSolid, voxelSizeFor(mesh, 50));
    const auto density = softDensity(test::oneObject(mesh), options);
    options.grids = std::vector{GridKind::kSurface};
    options.volume.band = 8;
    *options.voxelSize /= kFine;
    const auto distance = softDensity(test::oneObject(mesh), options);
    const auto [rms, most] = differenceFrom(*density, *distance, kFine);
    CAPTURE(mesh.faceCount(), rms, most);
    CHECK(rms < 0.01);
    CHECK(most < 0.25);
  }
}

TEST_CASE("soft values end where their part is 0, and are 1 deep inside", "[soft][property]") {
  for (const Fill fill : {Fill::kSolid, Fill::kSurface})
    for (const auto* shapes : {&test::shapes(), &test::openShapes()})
      for (const auto& shape : *shapes) {
        CAPTURE(shape.name, fill == Fill::kSolid);
        const auto density = softDensity(test::oneObject(shape.mesh),
                                         softOptions(fill, voxelSizeFor(shape.mesh, 24)));
        CHECK(density->activeVoxelCount() > 0);
        for (auto value = density->cbeginValueAll(); value; ++value)
          REQUIRE((value.isValueOn() ? *value > 0 && *value <= 1 : *value == 0));
      }
  const auto cube = softDensity(test::oneObject(test::cube()), softOptions(Fill::kSolid, 1.0 / 64));
  CHECK(cube->tree().getValue({0, 0, 0}) == 1);
  CHECK(cube->tree().getValue({80, 0, 0}) == 0);
}

TEST_CASE("gain, target and 16 bits are those of hard densities", "[soft]") {
  ConvertOptions options = softOptions(Fill::kSolid, 1.0 / 32);
  const auto one = softDensity(test::oneObject(test::cube()), options);
  options.volume.gain.reset();
  const auto blender = softDensity(test::oneObject(test::cube()), options);
  CHECK(blender->metaValue<float>("vox_gain") == 192);
  REQUIRE(blender->tree().hasSameTopology(one->tree()));
  for (auto value = one->cbeginValueOn(); value; ++value)
    REQUIRE(blender->tree().getValue(value.getCoord()) == Approx(*value * 192).epsilon(1e-6));
  options.volume.target = Target::kHoudini;
  options.volume.half = true;
  const auto houdini = softDensity(test::oneObject(test::cube()), options);
  CHECK(houdini->tree().getValue({0, 0, 0}) == 1);
  CHECK(houdini->saveFloatAsHalf());
}

TEST_CASE("an open component in a soft solid is a sheet", "[soft]") {
  const PolygonMesh sheet = test::scaled(test::regularPolygon(4), 10);
  const PolygonMesh body = test::moved(test::cube(), Vec3d(0, 0, 2));
  const double size = 0.1;
  const auto both = softDensity(test::oneObject(test::together(sheet, body, Vec3d(0, 0, 0))),
                                softOptions(Fill::kSolid, size));
  const auto shell = softDensity(test::oneObject(sheet), softOptions(Fill::kSurface, size));
  const auto solid = softDensity(test::oneObject(body), softOptions(Fill::kSolid, size));
  CHECK(volumeOf(*both) == Approx(volumeOf(*shell) + volumeOf(*solid)).epsilon(1e-6));
}

TEST_CASE("a cavity is soft too, and parts inside others leave no trace", "[soft]") {
  const PolygonMesh outer = test::scaled(test::cube(), 4);
  const double size = 0.1;
  const auto volume = [&](const PolygonMesh& mesh) {
    return volumeOf(*softDensity(test::oneObject(mesh), softOptions(Fill::kSolid, size)));
  };
  const PolygonMesh cavity = test::scaled(test::cube(), 2);
  CHECK(volume(test::together(outer, test::insideOut(cavity), Vec3d(0, 0, 0))) ==
        Approx(volume(outer) - volume(cavity)).epsilon(1e-3));
  CHECK(volume(test::together(outer, cavity, Vec3d(0, 0, 0))) ==
        Approx(volume(outer)).epsilon(1e-6));
}

TEST_CASE("polygons as they are have soft edges", "[soft][golden]") {
  ConvertOptions options = softOptions(Fill::kSolid, 0.1);
  options.until = StopRule{.levels = 0};
  // Faces through voxel centres: half of each voxel, but a quarter at edges, an eighth at corners,
  // for which the plane through the foot takes half.
  const auto density = softDensity(test::oneObject(test::cube()), options);
  CHECK(density->tree().getValue({0, 0, 10}) == Approx(0.5).margin(1e-5));
  CHECK(density->tree().getValue({0, 0, 9}) == 1);
  CHECK(density->tree().getValue({0, 0, 11}) == 0);
  options.volume.fill = Fill::kSurface;
  const auto shell = softDensity(test::oneObject(test::cube()), options);
  CHECK(shell->tree().getValue({0, 0, 10}) == Approx(1).margin(1e-5));
  CHECK(shell->tree().getValue({0, 0, 8}) == 0);
}

TEST_CASE("thread count never changes soft densities", "[soft][parallel]") {
  for (const Fill fill : {Fill::kSolid, Fill::kSurface}) {
    ConvertOptions options = softOptions(fill, 1.0 / 40);
    const Scene scene = test::sceneOf({test::dodecahedron(), test::sheet(5, 4)});
    options.run.threads = 1;
    const std::string first = test::bytesOf(convert(scene, options));
    for (const int threads : {2, 8}) {
      options.run.threads = threads;
      CHECK(test::bytesOf(convert(scene, options)) == first);
    }
  }
}

namespace {

openvdb::MaskTree::Ptr grownTopology(const openvdb::GridBase& grid, int voxels) {
  openvdb::MaskTree::Ptr tree;
  grid.apply<openvdb::TypeList<openvdb::FloatGrid, openvdb::Vec3SGrid>>([&](const auto& typed) {
    tree = std::make_shared<openvdb::MaskTree>(typed.tree(), false, true, openvdb::TopologyCopy());
  });
  if (voxels > 0)
    openvdb::tools::dilateActiveValues(*tree, voxels, openvdb::tools::NN_FACE_EDGE_VERTEX);
  return tree;
}

bool haveSameVoxels(const openvdb::MaskTree& a, const openvdb::MaskTree& b) {
  openvdb::MaskTree onlyA(a);
  onlyA.topologyDifference(b);
  return onlyA.activeVoxelCount() == 0 && a.activeVoxelCount() == b.activeVoxelCount();
}

}  // namespace

TEST_CASE("normals cover a soft density, and colours one voxel more", "[soft][property]") {
  ConvertOptions options = softOptions(Fill::kSurface, 1.0 / 20);
  options.grids = std::vector{GridKind::kColor, GridKind::kNormal, GridKind::kDensity};
  const Scene scene =
      test::sceneOf({test::dodecahedron(), test::moved(test::torusGrid(9, 6), Vec3d(3, 0, 0)),
                     test::sheet(4, 3)});
  const Conversion made = convert(scene, options);
  REQUIRE(namesOf(made) == std::vector<std::string>{"color", "normal", "density"});
  CHECK(haveSameVoxels(*grownTopology(*made.grids[1], 0), *grownTopology(*made.grids[2], 0)));
  CHECK(haveSameVoxels(*grownTopology(*made.grids[0], 0), *grownTopology(*made.grids[2], 1)));
  const auto normals = openvdb::gridPtrCast<openvdb::Vec3SGrid>(made.grids[1]);
  for (auto normal = normals->cbeginValueOn(); normal; ++normal)
    REQUIRE(normal->length() == Approx(1).epsilon(1e-5));

  options.volume.fill = Fill::kSolid;
  const Conversion solid = convert(scene, options);
  options.grids = std::vector{GridKind::kMask};
  const Conversion surface = convert(scene, options);
  openvdb::MaskTree near(test::maskOf(surface).tree());
  openvdb::tools::dilateActiveValues(near, 1, openvdb::tools::NN_FACE_EDGE_VERTEX);
  near.topologyIntersection(*grownTopology(*solid.grids[2], 0));
  CHECK(haveSameVoxels(*grownTopology(*solid.grids[1], 0), near));
  openvdb::tools::dilateActiveValues(near, 1, openvdb::tools::NN_FACE_EDGE_VERTEX);
  CHECK(haveSameVoxels(*grownTopology(*solid.grids[0], 0), near));
}

TEST_CASE("colours around a soft density are those of the closest object", "[soft]") {
  PolygonMesh red = test::cube();
  red.faceColors.assign(red.faceCount(), Eigen::Vector3f(1, 0, 0));
  const double size = 0.1;
  for (const std::optional<int> levels : {std::optional<int>(), std::optional<int>(0)}) {
    Scene scene = test::sceneOf({red, test::moved(test::cube(), Vec3d(5, 0, 0)),
                                 test::moved(test::cube(), Vec3d(10, 0, 0))});
    scene.objects[1].texture = parseTexture("checker:colors=0:0:1/0:0:1");
    for (const Fill fill : {Fill::kSurface, Fill::kSolid}) {
      ConvertOptions options = softOptions(fill, size);
      options.grids = std::vector{GridKind::kColor, GridKind::kDensity};
      if (levels) options.until = StopRule{.levels = *levels};
      const Conversion made = convert(scene, options);
      const auto& colors = test::colorOf(made);
      for (auto color = colors.cbeginValueOn(); color; ++color) {
        const double x = color.getCoord().x() * size;
        const openvdb::Vec3f expected = x < 2.5   ? openvdb::Vec3f(1, 0, 0)
                                        : x < 7.5 ? openvdb::Vec3f(0, 0, 1)
                                                  : openvdb::Vec3f(0.8F);
        REQUIRE((*color - expected).length() < 1e-5F);
      }
    }
  }
}

namespace {

bool isSoft(const Conversion& conversion) {
  const auto edge = (*conversion.grids[0])["vox_edge"];
  return edge && edge->str() == "soft";
}

}  // namespace

TEST_CASE("densities are soft for Blender and hard for Houdini unless asked", "[soft]") {
  for (const auto& [target, soft] :
       {std::pair(Target::kBlender, true), std::pair(Target::kBlender34, true),
        std::pair(Target::kHoudini, false)}) {
    ConvertOptions options;
    options.voxelSize = 0.1;
    options.volume.target = target;
    const Scene scene = test::oneObject(test::cube());
    const auto byDefault = convert(scene, options);
    CHECK(isSoft(byDefault) == soft);
    options.volume.edge = soft ? Edge::kHard : Edge::kSoft;
    CHECK(isSoft(convert(scene, options)) != soft);
    options.volume.edge = soft ? Edge::kSoft : Edge::kHard;
    const auto same = convert(scene, options);
    CHECK(
        openvdb::gridPtrCast<openvdb::FloatGrid>(same.grids[0])
            ->tree()
            .hasSameTopology(openvdb::gridPtrCast<openvdb::FloatGrid>(byDefault.grids[0])->tree()));
  }
}
