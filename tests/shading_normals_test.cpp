#include "libvox/volume/shading_normals.h"

#include "libvox/pipeline/convert.h"
#include "libvox/pipeline/refine.h"
#include "libvox/render/ray_cast.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include <map>
#include <numbers>
#include <random>

using namespace vox;
using openvdb::Coord;

namespace {

double degreesBetween(const Vec3d& a, const Vec3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b)) * 180 / std::numbers::pi;
}

/// The voxels z = round(height(x, y)).
template <class Height>
openvdb::MaskTree terrain(Height&& height) {
  openvdb::MaskTree voxels;
  for (int x = -30; x <= 30; ++x)
    for (int y = -30; y <= 30; ++y)
      voxels.setValueOn(Coord(x, y, static_cast<int>(std::lround(height(x, y)))));
  return voxels;
}

/// The simple method: differences of heights across one column to each side. Heights are those of
/// the first voxels seen along the axis that is closest to the line of sight.
Vec3d centralDifference(const openvdb::MaskTree& voxels, const Coord& voxel, const Vec3d& view) {
  int up = 0;
  view.cwiseAbs().maxCoeff(&up);
  const int sign = view[up] < 0 ? -1 : 1;
  Vec3d normal = Vec3d::Zero();
  normal[up] = sign;
  for (int axis = 0; axis < 3; ++axis) {
    if (axis == up) continue;
    const auto heightBeside = [&](int side) {
      for (int height = 4; height >= -4; --height) {
        Coord at = voxel;
        at[axis] += side;
        at[up] += sign * height;
        if (voxels.isValueOn(at)) return height;
      }
      return 0;
    };
    normal[axis] = -(heightBeside(1) - heightBeside(-1)) / 2.0;
  }
  return normal.normalized();
}

/// For each voxel, the mean limit normal of the faces whose limit point lies in it. The mesh is
/// subdivided until its faces are smaller than voxels. Limit point and normal of a face have closed
/// forms: the centroid and T1 x T2.
std::map<Coord, Vec3d> limitNormals(const Scene& scene, int levels, double voxelSize) {
  const PolygonMesh fine = refine(scene, levels, {}, {}).mesh;
  std::map<Coord, Vec3d> normals;
  for (Index f = 0; f < fine.faceCount(); ++f) {
    const auto face = fine.face(f);
    Vec3d centre = Vec3d::Zero();
    Vec3d t1 = Vec3d::Zero();
    Vec3d t2 = Vec3d::Zero();
    for (std::size_t j = 0; j < face.size(); ++j) {
      const Vec3d& point = fine.points[face[j]];
      const double angle = 2 * std::numbers::pi * double(j) / double(face.size());
      centre += point / double(face.size());
      t1 += std::cos(angle) * point;
      t2 += std::sin(angle) * point;
    }
    const Vec3d at = centre / voxelSize;
    const Coord voxel = Coord::round(openvdb::Vec3d(at.x(), at.y(), at.z()));
    normals.emplace(voxel, Vec3d::Zero()).first->second += t1.cross(t2).normalized();
  }
  return normals;
}

}  // namespace

TEST_CASE("planes of any slope have the normal of the plane", "[volume][golden]") {
  double sum = 0;
  int count = 0;
  for (const double p : {-1.0, -0.4, 0.0, 0.13, 0.9})
    for (const double q : {-0.7, 0.0, 0.29, 1.0}) {
      CAPTURE(p, q);
      const openvdb::MaskTree voxels = terrain([&](int x, int y) { return p * x + q * y; });
      CongradientNormals normals(voxels);
      const Vec3d exact = Vec3d(-p, -q, 1).normalized();
      for (int x = -9; x <= 9; ++x) {
        const Coord voxel(x, 2, static_cast<int>(std::lround(p * x + q * 2)));
        const double above = degreesBetween(normals.at(voxel, Vec3d(0, 0, 1), exact), exact);
        const double below = degreesBetween(normals.at(voxel, Vec3d(0, 0, -1), -exact), -exact);
        // In the worst case, rounding of heights changes the slope over 13 columns by 0.115.
        CHECK(std::max(above, below) < 6.6);
        sum += above + below;
        count += 2;
      }
    }
  CHECK(sum / count < 1.5);
}

TEST_CASE("the normal beside an edge is that of its own side", "[volume][golden]") {
  const openvdb::MaskTree roof = terrain([](int x, int) { return -std::abs(x); });
  CongradientNormals normals(roof);
  for (const int x : {-12, -4, -2, 2, 4, 12}) {
    CAPTURE(x);
    const Vec3d side = Vec3d(x < 0 ? -1 : 1, 0, 1).normalized();
    const Vec3d up(0, 0, 1);
    CHECK(degreesBetween(normals.at(Coord(x, 0, -std::abs(x)), up, up), side) < 3);
  }
}

TEST_CASE("a voxel alone, and the end of a sheet, have normals, too", "[volume]") {
  openvdb::MaskTree voxels;
  voxels.setValueOn(Coord(0, 0, 0));
  for (int x = 100; x < 120; ++x)
    for (int y = 0; y < 20; ++y) voxels.setValueOn(Coord(x, y, 0));
  CongradientNormals normals(voxels);
  for (const Vec3d& face : {Vec3d(1, 0, 0), Vec3d(0, -1, 0), Vec3d(0, 0, 1)})
    CHECK(normals.at(Coord(0, 0, 0), face, face) == face);
  const Vec3d up(0, 0, 1);
  const Vec3d slanting = Vec3d(-1, 0, 0.5).normalized();
  CHECK(normals.at(Coord(100, 10, 0), up, up) == up);
  CHECK(normals.at(Coord(100, 0, 0), Vec3d(-1, 0, 0), slanting) == up);
}

TEST_CASE("congradient normals lie far closer to limit normals than central differences",
          "[volume][property]") {
  const auto [name, levels, most] = GENERATE(table<std::string, int, double>(
      {{"torus.toml", 6, 2}, {"toy_jack.toml", 6, 4.5}, {"polyhedron.toml", 7, 1.5}}));
  CAPTURE(name);
  const Scene scene = readScene(std::string(VOX_SCENES) + "/" + name);
  ConvertOptions options;
  options.dim = 128;
  options.grids = std::vector{GridKind::kMask};
  const Conversion conversion = convert(scene, options);
  const auto& voxels = openvdb::gridPtrCast<openvdb::MaskGrid>(conversion.grids.front())->tree();
  const auto limits = limitNormals(scene, levels, conversion.report.voxelSize);
  const auto caster = voxelCaster(voxels);
  CongradientNormals normals(voxels);

  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  double ours = 0;
  double plain = 0;
  int count = 0;
  int insideOut = 0;
  for (const auto& [aim, unused] : limits) {  // from anywhere, through that voxel
    const Vec3d view = Vec3d(normal(random), normal(random), normal(random)).normalized();
    const Vec3d eye = Vec3d(aim.x(), aim.y(), aim.z()) + 1000 * view;
    const auto hit =
        caster->firstHit(IndexRay({eye.x(), eye.y(), eye.z()}, {-view.x(), -view.y(), -view.z()}));
    const auto limit = hit ? limits.find(hit->voxel) : limits.end();
    if (limit == limits.end()) continue;
    const double error = degreesBetween(normals.at(hit->voxel, hit->face, view), limit->second);
    ours += error;
    insideOut += error > 90;
    plain += degreesBetween(centralDifference(voxels, hit->voxel, view), limit->second);
    ++count;
  }
  REQUIRE(count > 10000);
  CAPTURE(ours / count, plain / count);
  CHECK(ours / count < most);
  CHECK(ours < plain / 3);
  CHECK(insideOut * 1000 < count);
}
