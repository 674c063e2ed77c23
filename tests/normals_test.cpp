#include "libvox/core/error.h"
#include "libvox/core/parallel.h"
#include "libvox/grid/openvdb.h"
#include "libvox/pipeline/convert.h"
#include "libvox/subdivide/doo_sabin.h"
#include "tests/shapes.h"
#include "tests/spline_torus.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

using namespace vox;

namespace {

openvdb::Vec3SGrid::Ptr normalsOf(const PolygonMesh& mesh, ConvertOptions options) {
  options.grids = std::vector{GridKind::kNormal};
  Scene scene;
  scene.objects.push_back({"object", mesh});
  return openvdb::gridPtrCast<openvdb::Vec3SGrid>(convert(scene, options).grids[0]);
}

ConvertOptions atDim(int dim) {
  ConvertOptions options;
  options.dim = dim;
  return options;
}

Vec3d vectorOf(const openvdb::Vec3s& v) {
  return {v.x(), v.y(), v.z()};
}

double degrees(const Vec3d& a, const Vec3d& b) {
  return std::acos(std::clamp(a.normalized().dot(b.normalized()), -1.0, 1.0)) * 180 /
         std::numbers::pi;
}

/// Mean and largest angle, in degrees, between the normals of a grid and those of a rule.
/// @param oneIn  compares only one voxel of so many
template <class Rule>
std::pair<double, double> errors(const openvdb::Vec3SGrid& grid, Rule&& rule, int oneIn = 1) {
  double sum = 0;
  double most = 0;
  int count = 0;
  for (auto voxel = grid.cbeginValueOn(); voxel; ++voxel) {
    if (count++ % oneIn != 0) continue;
    const auto at = grid.transform().indexToWorld(voxel.getCoord());
    const double error = degrees(vectorOf(*voxel), rule(Vec3d(at.x(), at.y(), at.z())));
    sum += error;
    most = std::max(most, error);
  }
  return {sum * oneIn / count, most};
}

}  // namespace

TEST_CASE("normals have length 1 and stand at the active voxels", "[normals][property]") {
  for (const auto& shape : test::shapes()) {
    CAPTURE(shape.name);
    ConvertOptions options = atDim(24);
    options.grids = std::vector{GridKind::kMask, GridKind::kNormal};
    Scene scene;
    scene.objects.push_back({shape.name, shape.mesh});
    const Conversion conversion = convert(scene, options);
    const auto mask = openvdb::gridPtrCast<openvdb::MaskGrid>(conversion.grids[0]);
    const auto normals = openvdb::gridPtrCast<openvdb::Vec3SGrid>(conversion.grids[1]);
    CHECK(normals->getName() == "normal");
    CHECK(normals->tree().hasSameTopology(mask->tree()));
    for (auto voxel = normals->cbeginValueOn(); voxel; ++voxel)
      REQUIRE(voxel->length() == Approx(1).epsilon(1e-6));
  }
}

TEST_CASE("a flat sheet has its normal everywhere", "[normals][golden]") {
  const PolygonMesh tilted =
      test::meshOf({{0, 0, 0}, {3, 0, 1}, {3, 3, 2}, {0, 3, 1}}, {{0, 1, 2, 3}});
  const Vec3d normal = Vec3d(-1, -1, 3).normalized();
  for (const std::optional<int> levels : {std::optional<int>(), {0}, {1}, {3}}) {
    ConvertOptions options = atDim(60);
    if (levels) options.until = StopRule{.levels = levels};
    const auto grid = normalsOf(tilted, options);
    // One voxel or more in each column: the surface covers 5/6 of the 60 x 60 at least.
    CHECK(grid->activeVoxelCount() >= 3000);
    CHECK(errors(*grid, [&](const Vec3d&) { return normal; }).second < 1e-4);
  }
}

TEST_CASE("normals of a round surface point away from its axis", "[normals][property]") {
  // A ring of many quads: its limit surface is a torus up to a part in a thousand.
  const PolygonMesh ring = test::torusGrid(64, 48);
  double largest = 0;
  for (const Vec3d& p : ring.points) largest = std::max(largest, std::hypot(p.x(), p.y()));
  double tube = 0;
  for (const Vec3d& p : ring.points) tube = std::max(tube, std::abs(p.z()));
  const double around = largest - tube;
  const auto outward = [&](const Vec3d& p) -> Vec3d {
    const Vec3d flat(p.x(), p.y(), 0);
    return p - around * flat.normalized();
  };
  for (const int dim : {32, 64, 128}) {
    const auto [mean, most] = errors(*normalsOf(ring, atDim(dim)), outward);
    CAPTURE(dim, mean, most);
    CHECK(mean < 0.2);  // how far the ring is from round
  }
}

TEST_CASE("normals of polygons are those of the smooth surface, not of facets",
          "[normals][property]") {
  // Measured mean errors in degrees: flat normals of the polygons 7.0, 2.8, 1.5; normals blended
  // over the polygons 1.1, 0.45, 0.18.
  const PolygonMesh ring = test::torusGrid(9, 6);
  const test::SplineTorus torus(9, 6);
  const std::vector<std::pair<int, double>> cases = {{1, 0.02}, {2, 0.02}, {3, 0.01}};
  for (const auto& [levels, voxelSize] : cases) {
    ConvertOptions options;
    options.voxelSize = voxelSize;
    const auto errorsOf = [&](const PolygonMesh& mesh) {
      return errors(
          *normalsOf(mesh, options), [&](const Vec3d& p) { return torus.normalNear(p); }, 7);
    };
    options.until = StopRule{.levels = levels};
    const auto [smooth, most] = errorsOf(ring);
    options.until = StopRule{.levels = 0};
    const auto [flat, mostFlat] = errorsOf(subdivide(baseLevel(ring), levels).mesh);
    CAPTURE(levels, smooth, most, flat, mostFlat);
    CHECK(smooth < flat / 4);
    CHECK(most < mostFlat / 2);
  }
}

TEST_CASE("polygons by any rule have unit normals, open or folded", "[normals][property]") {
  for (const auto* shapes : {&test::shapes(), &test::openShapes()})
    for (const auto& shape : *shapes)
      for (const auto boundary : {BoundaryRule::kExtend, BoundaryRule::kFree}) {
        CAPTURE(shape.name, boundary == BoundaryRule::kFree);
        if (boundary == BoundaryRule::kFree && shape.mesh.faceCount() == 1) continue;  // a dot
        ConvertOptions options = atDim(24);
        options.smoothing.boundary = boundary;
        options.until = StopRule{.angle = 10};
        const auto grid = normalsOf(shape.mesh, options);
        for (auto voxel = grid->cbeginValueOn(); voxel; ++voxel)
          REQUIRE(voxel->length() == Approx(1).epsilon(1e-6));
      }
}

TEST_CASE("polygons as they are have flat normals", "[normals][golden]") {
  ConvertOptions options = atDim(16);
  options.until = StopRule{.levels = 0};
  const auto grid = normalsOf(test::cube(), options);
  const auto box = grid->evalActiveVoxelBoundingBox();
  const openvdb::Coord middle = (box.min() + box.max()) >> 1;
  for (int axis = 0; axis < 3; ++axis)
    for (const bool top : {false, true}) {
      openvdb::Coord at = middle;
      at[axis] = top ? box.max()[axis] : box.min()[axis];
      openvdb::Vec3s expected(0, 0, 0);
      expected[axis] = top ? 1.0F : -1.0F;
      CHECK((grid->tree().getValue(at) - expected).length() < 1e-6);
    }
  // At a corner, the mean of the normals of three faces.
  const openvdb::Vec3s corner = grid->tree().getValue(box.max());
  CHECK(degrees(vectorOf(corner), {1, 1, 1}) < 25);
}

TEST_CASE("thread count never changes normals", "[normals][parallel]") {
  for (const bool polygons : {false, true}) {
    ConvertOptions options = atDim(80);
    if (polygons) options.until = StopRule{.flatness = 0.1};
    const auto first = normalsOf(test::dodecahedron(), options);
    for (const int threads : {1, 2, 8}) {
      options.run.threads = threads;
      const auto other = normalsOf(test::dodecahedron(), options);
      REQUIRE(other->tree().hasSameTopology(first->tree()));
      for (auto voxel = first->cbeginValueOn(); voxel; ++voxel)
        REQUIRE(other->tree().getValue(voxel.getCoord()) == *voxel);
    }
  }
}
