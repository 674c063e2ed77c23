// Level sets against exact closest points of the limit surface.

#include "libvox/grid/openvdb.h"
#include "libvox/pipeline/convert.h"
#include "tests/closest_point.h"
#include "tests/level_set_errors.h"
#include "tests/repaired_level.h"
#include "tests/scenes.h"
#include "tests/shapes.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>

using namespace vox;
using test::sceneOf;

namespace {

constexpr int kDeepEnough = 14;  // triangles of the truth are 2^-14 of a face
constexpr std::size_t kSamples = 2000;

openvdb::FloatGrid::ConstPtr exactSurfaceOf(const PolygonMesh& mesh, double voxelSize,
                                            const BandWidths& band) {
  ConvertOptions options;
  options.voxelSize = voxelSize;
  options.grids = std::vector{GridKind::kSurface};
  options.volume.band = band;
  const Conversion conversion = convert(sceneOf({mesh}), options);
  return openvdb::gridConstPtrCast<openvdb::FloatGrid>(
      openvdb::GridBase::ConstPtr(conversion.grids.at(0)));
}

double voxelSizeFor(const PolygonMesh& mesh, double voxelsAcross) {
  return usedBox(mesh).longestSide() / voxelsAcross;
}

/// @param rms, largest  at most these errors, voxels
void requireErrors(const PolygonMesh& mesh, double voxelSize, const BandWidths& band, double rms,
                   double largest) {
  const test::ClosestPoint truth(test::repairedLevel(mesh, 1 / voxelSize), kDeepEnough);
  const auto grid = exactSurfaceOf(mesh, voxelSize, band);
  const auto errors = test::compareLevelSet(*grid, truth, voxelSize, band.in, band.out, kSamples);
  CHECK(grid->background() == Approx(band.out * voxelSize));
  CAPTURE(errors.rms, errors.largest, errors.active, errors.near);
  CHECK(errors.rms <= rms);
  CHECK(errors.largest <= largest);
  CHECK(errors.wrongSigns == 0);
  CHECK(errors.surplus == 0);
  CHECK(errors.missing == 0);
  CHECK(errors.wrongBackgrounds == 0);
  CHECK(errors.wrongSides == 0);
}

void requireExact(const PolygonMesh& mesh, double voxelsAcross, const BandWidths& band) {
  // Of an object below a voxel all errors of the shape add up: 1.7e-3 was the largest, on prism 12.
  requireErrors(mesh, voxelSizeFor(mesh, voxelsAcross), band, voxelsAcross < 1 ? 2e-3 : 1e-3, 0.02);
}

}  // namespace

TEST_CASE("level sets are exact for all shapes, from a few voxels to many",
          "[level-set][property]") {
  for (const auto& shape : test::shapes()) {
    if (!shape.closed) continue;
    for (const double voxelsAcross : {0.5, 3.0, 12.0, 50.0, 130.0}) {
      CAPTURE(shape.name, voxelsAcross);
      requireExact(shape.mesh, voxelsAcross, 3);
    }
  }
}

TEST_CASE("level sets of dense triangle meshes are exact to some thousandths of a voxel",
          "[level-set][property]") {
  for (const double jitter : {0.0, 0.03})
    for (const double voxelSize : {0.6, 1.5, 4.0}) {
      CAPTURE(jitter, voxelSize);
      requireErrors(test::wavyTriangles(60, jitter), voxelSize, 3, 0.007, 0.045);
    }
}

TEST_CASE("level sets are exact where the band is wider than the object", "[level-set][property]") {
  for (const auto& shape : test::shapes()) {
    if (!shape.closed) continue;
    CAPTURE(shape.name);
    requireExact(shape.mesh, 15, 11);
  }
}

TEST_CASE("level sets are exact where the band has two widths", "[level-set][property]") {
  for (const auto& shape : test::shapes()) {
    if (!shape.closed) continue;
    for (const BandWidths band : {BandWidths(1, 6), BandWidths(9, 2.5)}) {
      CAPTURE(shape.name, band.in, band.out);
      requireExact(shape.mesh, 15, band);
    }
  }
}

TEST_CASE("a band that is wide inside fills the inside with distances", "[level-set]") {
  for (const BandWidths band : {BandWidths(18, 3), BandWidths(1000, 3)}) {
    for (const auto& mesh : {test::cube(), test::torusGrid(12, 8)}) {
      const double voxelsAcross = 30;
      CAPTURE(band.in);
      requireExact(mesh, voxelsAcross, band);
      const auto grid = exactSurfaceOf(mesh, voxelSizeFor(mesh, voxelsAcross), band);
      for (auto value = grid->cbeginValueOff(); value; ++value)
        REQUIRE(*value == grid->background());
    }
  }
}

TEST_CASE("wide bands are exact on both sides", "[level-set][property]") {
  for (const BandWidths band : {BandWidths(2, 32), BandWidths(28, 4), BandWidths(25, 33)}) {
    CAPTURE(band.in, band.out);
    requireExact(test::cube(), 60, band);
    requireExact(test::torusGrid(12, 8), 60, band);
  }
}

TEST_CASE("normals are those of the limit surface at the closest point", "[normals][property]") {
  for (const auto& shape : test::shapes()) {
    if (!shape.closed) continue;
    const double voxelSize = voxelSizeFor(shape.mesh, 60);
    const test::ClosestPoint truth(test::repairedLevel(shape.mesh, 1 / voxelSize), kDeepEnough);
    ConvertOptions options;
    options.voxelSize = voxelSize;
    options.grids = std::vector{GridKind::kNormal};
    const Conversion conversion = convert(sceneOf({shape.mesh}), options);
    const auto grid = openvdb::gridConstPtrCast<openvdb::Vec3SGrid>(
        openvdb::GridBase::ConstPtr(conversion.grids.at(0)));
    double sum = 0;
    double count = 0;
    double largest = 0;
    for (auto value = grid->cbeginValueOn(); value; ++value) {
      const auto voxel = value.getCoord();
      const Vec3d expected = truth.of(Vec3d(voxel.x(), voxel.y(), voxel.z())).normal;
      const Vec3d normal((*value)[0], (*value)[1], (*value)[2]);
      const double sine = normal.cross(expected).norm();
      const double degrees = std::atan2(sine, normal.dot(expected)) * 180 / std::acos(-1.0);
      sum += degrees * degrees;
      largest = std::max(largest, degrees);
      ++count;
    }
    CAPTURE(shape.name, count, largest);
    // The two tips of the bow tie are rounder than a voxel.
    CHECK(std::sqrt(sum / count) <= (shape.name == "bow tie" ? 0.06 : 0.05));
  }
}

TEST_CASE("distances without sign are widened, too", "[level-set]") {
  const PolygonMesh flat = test::sheet(4, 4);
  ConvertOptions options;
  options.voxelSize = 0.1;
  options.grids = std::vector{GridKind::kSurface};
  options.volume.openMesh = OpenMesh::kUnsigned;
  options.volume.band = BandWidths(3, 25);
  const Conversion conversion = convert(sceneOf({flat}), options);
  const auto grid = openvdb::gridConstPtrCast<openvdb::FloatGrid>(
      openvdb::GridBase::ConstPtr(conversion.grids.at(0)));
  CHECK(grid->tree().getValue({20, 20, 24}) == Approx(2.4).margin(0.05));
  CHECK(grid->tree().getValue({20, 20, -24}) == Approx(2.4).margin(0.05));
}
