// Soft densities of bodies that overlap, against the exact part of each voxel in their union.

#include "libvox/grid/openvdb.h"
#include "libvox/mesh/area_vector.h"
#include "libvox/pipeline/convert.h"
#include "libvox/subdivide/doo_sabin.h"
#include "tests/scenes.h"
#include "tests/shapes.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

using namespace vox;
using openvdb::Coord;

namespace {

/// A convex body: the points below all its planes.
class ConvexBody {
 public:
  /// @param mesh  convex, flat faces that face outward
  explicit ConvexBody(const PolygonMesh& mesh) {
    for (const Vec3d& p : mesh.points) box_.add(p);
    for (Index f = 0; f < mesh.faceCount(); ++f) {
      const auto face = mesh.face(f);
      const Vec3d normal = twiceAreaVector(face.size(), [&](std::size_t i) -> const Vec3d& {
                             return mesh.points[face[i]];
                           }).normalized();
      planes_.push_back({normal, normal.dot(test::faceCentroid(mesh, f))});
    }
  }

  /// Of the planes, the largest distance; negative inside.
  double height(const Vec3d& p) const {
    double most = -1e9;
    for (const auto& [normal, offset] : planes_) most = std::max(most, normal.dot(p) - offset);
    return most;
  }
  bool near(const Vec3d& p, double size) const {
    return (p.array() > box_.low.array() - size).all() &&
           (p.array() < box_.high.array() + size).all();
  }
  /// The planes that may cross a voxel.
  ConvexBody near(const Vec3d& middle, double size, int) const {
    ConvexBody few = *this;
    std::erase_if(few.planes_, [&](const Plane& plane) {
      return plane.normal.dot(middle) - plane.offset < -0.9 * size;
    });
    return few;
  }

 private:
  struct Plane {
    Vec3d normal;
    double offset;
  };
  std::vector<Plane> planes_;
  Box box_;
};

/// The limit surface of a convex mesh, or the mesh itself if it is not to be smoothed: as the body
/// between the tangent planes at its places.
ConvexBody bodyOf(const PolygonMesh& mesh, bool smooth) {
  return ConvexBody(smooth ? subdivide(baseLevel(mesh), 4).mesh : mesh);
}

/// The part of a voxel in the union of bodies, from samples; empty if no surface is near.
double partIn(const std::vector<ConvexBody>& bodies, const Vec3d& middle, double size) {
  constexpr int kSamples = 8;  // along each axis
  std::vector<ConvexBody> crossing;
  for (const ConvexBody& body : bodies) {
    if (!body.near(middle, size)) continue;
    const double height = body.height(middle);
    if (height < -0.9 * size) return 1;
    if (height < 0.9 * size) crossing.push_back(body.near(middle, size, 0));
  }
  if (crossing.empty()) return 0;
  int inside = 0;
  for (int x = 0; x < kSamples; ++x)
    for (int y = 0; y < kSamples; ++y)
      for (int z = 0; z < kSamples; ++z) {
        const Vec3d p = middle + size * ((Vec3d(x, y, z) + Vec3d::Constant(0.5)) / kSamples -
                                         Vec3d::Constant(0.5));
        inside += std::any_of(crossing.begin(), crossing.end(),
                              [&](const ConvexBody& body) { return body.height(p) < 0; });
      }
  return inside / std::pow(kSamples, 3);
}

enum class Way { kSmooth, kPolygons };

openvdb::FloatGrid::Ptr softSolid(const Scene& scene, Way way, double size) {
  ConvertOptions options;
  options.voxelSize = size;
  options.volume.fill = Fill::kSolid;
  options.volume.edge = Edge::kSoft;
  options.volume.gain = 1;
  if (way == Way::kPolygons) options.until = StopRule{.levels = 0};
  return openvdb::gridPtrCast<openvdb::FloatGrid>(convert(scene, options).grids[0]);
}

/// Differences of soft values from the exact part of the voxel.
struct Errors {
  double rms = 0;   // of the voxels that the surface of the union crosses
  double most = 0;  // of all voxels
  double full = 0;  // of the voxels wholly inside
};

Errors errorsOf(const openvdb::FloatGrid& soft, const std::vector<PolygonMesh>& meshes, Way way) {
  std::vector<ConvexBody> bodies;
  for (const PolygonMesh& mesh : meshes) bodies.push_back(bodyOf(mesh, way == Way::kSmooth));
  openvdb::CoordBBox box = soft.evalActiveVoxelBoundingBox();
  box.expand(1);
  const auto values = soft.getConstAccessor();
  const double size = soft.voxelSize()[0];
  Errors errors;
  int count = 0;
  for (auto at = box.begin(); at; ++at) {
    const double part = partIn(bodies, size * Vec3d((*at).x(), (*at).y(), (*at).z()), size);
    const double error = std::abs(double{values.getValue(*at)} - part);
    errors.most = std::max(errors.most, error);
    if (part == 1) errors.full = std::max(errors.full, error);
    if (part == 0 || part == 1) continue;
    errors.rms += error * error;
    ++count;
  }
  errors.rms = std::sqrt(errors.rms / count);
  return errors;
}

PolygonMesh turned(PolygonMesh mesh, const Eigen::Matrix3d& rotation) {
  for (Vec3d& p : mesh.points) p = rotation * p;
  return mesh;
}

std::vector<PolygonMesh> randomBodies(std::mt19937& random, int count) {
  std::uniform_real_distribution<double> unit(-1, 1);
  std::vector<PolygonMesh> meshes;
  for (int i = 0; i < count; ++i) {
    const Eigen::Quaterniond q(unit(random), unit(random), unit(random), unit(random));
    const PolygonMesh mesh = i % 2 == 0 ? test::cube() : test::dodecahedron();
    const Vec3d shift(unit(random), unit(random), unit(random));
    meshes.push_back(test::moved(turned(mesh, q.normalized().toRotationMatrix()), shift,
                                 0.7 + 0.5 * unit(random)));
  }
  return meshes;
}

}  // namespace

TEST_CASE("a soft value is the part of the voxel in the union of bodies", "[soft][property]") {
  // Two planes of different bodies in a voxel are exact up to the samples of their overlap. At
  // edges of one body, a plane stands for two. A groove between bodies narrower than a voxel is
  // full, as it is in a hard density.
  for (const Way way : {Way::kSmooth, Way::kPolygons}) {
    const bool smooth = way == Way::kSmooth;
    std::mt19937 random(1);
    for (const int count : {3, 5, 7}) {
      const std::vector<PolygonMesh> meshes = randomBodies(random, count);
      PolygonMesh one;
      for (const PolygonMesh& mesh : meshes) one = test::together(one, mesh, Vec3d(0, 0, 0));
      const Scene scene = count == 5 ? test::oneObject(one) : test::sceneOf(meshes);
      const Errors errors = errorsOf(*softSolid(scene, way, 0.07), meshes, way);
      CAPTURE(smooth, count, errors.rms, errors.most, errors.full);
      CHECK(errors.rms < (smooth ? 0.01 : 0.03));
      CHECK(errors.most < 0.45);
      CHECK(errors.full < 0.05);
    }
  }
}

TEST_CASE("no seam is left in a soft density where two bodies touch", "[soft][property]") {
  const std::vector<PolygonMesh> cubes = {test::cube(), test::moved(test::cube(), Vec3d(2, 0, 0))};
  const Errors errors =
      errorsOf(*softSolid(test::sceneOf(cubes), Way::kPolygons, 0.13), cubes, Way::kPolygons);
  CAPTURE(errors.rms, errors.most);
  CHECK(errors.full < 1e-3);
  CHECK(errors.most < 0.1);
}

TEST_CASE("a sheet through a soft body adds nothing inside, and itself outside", "[soft]") {
  const PolygonMesh body = test::dodecahedron();
  const PolygonMesh sheet = test::moved(test::scaled(test::regularPolygon(4), 2), Vec3d(0, 0, 0.1));
  constexpr double kSize = 0.06;
  ConvertOptions shell;
  shell.voxelSize = kSize;
  shell.volume.gain = 1;
  shell.volume.edge = Edge::kSoft;
  const auto alone = softSolid(test::oneObject(body), Way::kSmooth, kSize);
  const auto both = softSolid(test::sceneOf({body, sheet}), Way::kSmooth, kSize);
  const auto sheets =
      openvdb::gridPtrCast<openvdb::FloatGrid>(convert(test::oneObject(sheet), shell).grids[0]);
  openvdb::CoordBBox box = both->evalActiveVoxelBoundingBox();
  for (auto at = box.begin(); at; ++at) {
    const float expected = std::max(alone->tree().getValue(*at), sheets->tree().getValue(*at));
    REQUIRE(both->tree().getValue(*at) == Approx(expected).margin(1e-5));
  }
}
