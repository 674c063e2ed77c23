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
#include <optional>
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

struct Errors {
  double rms = 0;  // of the voxels with a part between 0 and 1
  double most = 0;
  double fullMost = 0;  // of the voxels wholly inside
  int bad = 0;
  int wrong = 0;
};

Errors errorsOf(const std::vector<PolygonMesh>& meshes, bool smooth, bool oneObject, double size) {
  ConvertOptions options;
  options.voxelSize = size;
  options.volume.fill = Fill::kSolid;
  options.volume.edge = Edge::kSoft;
  options.volume.gain = 1;
  if (!smooth) options.until = StopRule{.levels = 0};
  Scene scene = test::sceneOf(meshes);
  std::vector<ConvexBody> bodies;
  for (const PolygonMesh& mesh : meshes) bodies.push_back(bodyOf(mesh, smooth));
  if (oneObject) {
    PolygonMesh all;
    for (const PolygonMesh& mesh : meshes) all = test::together(all, mesh, Vec3d(0, 0, 0));
    scene = test::oneObject(all);
  }
  const auto grid = openvdb::gridPtrCast<openvdb::FloatGrid>(convert(scene, options).grids[0]);
  openvdb::CoordBBox box = grid->evalActiveVoxelBoundingBox();
  box.expand(1);
  const auto accessor = grid->getConstAccessor();
  Errors errors;
  int count = 0;
  for (auto at = box.begin(); at; ++at) {
    const double part = partIn(bodies, size * Vec3d((*at).x(), (*at).y(), (*at).z()), size);
    const double error = std::abs(double{accessor.getValue(*at)} - part);
    if (part == 1) {
      errors.fullMost = std::max(errors.fullMost, error);
      if (error > 0.1) ++errors.bad;
    }
    if (part > 0 && part < 1) {
      errors.rms += error * error;
      ++count;
    }
    errors.most = std::max(errors.most, error);
    if (error > 0.3) {
      if (errors.wrong++ < 4)
        std::printf("   wrong: %d %d %d is %g, not %g\n", (*at).x(), (*at).y(), (*at).z(),
                    double{accessor.getValue(*at)}, part);
    }
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

TEST_CASE("overlapping experiment", "[softunion]") {
  const PolygonMesh cube = test::cube();
  const auto report = [](const char* name, const Errors& e) {
    std::printf("%-40s rms %.4f most %.3f full %.3f bad %d wrong %d\n", name, e.rms, e.most,
                e.fullMost, e.bad, e.wrong);
  };
  for (const bool smooth : {false, true})
    for (const bool one : {false, true}) {
      if (smooth == one) continue;
      std::printf("smooth %d one %d\n", smooth, one);
      report("one cube", errorsOf({cube}, smooth, one, 0.1));
      report("two cubes",
             errorsOf({cube, test::moved(cube, Vec3d(0.7, 0.5, 0.3))}, smooth, one, 0.1));
      report("aligned cubes",
             errorsOf({cube, test::moved(cube, Vec3d(1.13, 0, 0))}, smooth, one, 0.1));
      report("glued cubes", errorsOf({cube, test::moved(cube, Vec3d(2, 0, 0))}, smooth, one, 0.13));
      std::mt19937 random(1);
      for (int i = 0; i < 4; ++i)
        report("random", errorsOf(randomBodies(random, 3 + 2 * i), smooth, one, 0.07));
    }
}
