#include "libvox/subdivide/doo_sabin.h"
#include "libvox/voxelize/scan.h"
#include "tests/shapes.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <numbers>
#include <random>

using namespace vox;

namespace {

/// A surface of triangles.
struct Surface {
  std::vector<Vec3d> points;
  std::vector<std::array<Index, 3>> triangles;
};

Surface fanned(const PolygonMesh& mesh) {
  Surface surface;
  surface.points = mesh.points;
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    const auto face = mesh.face(f);
    for (std::size_t i = 2; i < face.size(); ++i)
      surface.triangles.push_back({face[0], face[i - 1], face[i]});
  }
  return surface;
}

/// The active voxels of [-side, side]^3.
class Cube {
 public:
  Cube(const Surface& surface, Separation separation, int side)
      : side_(side), active_(static_cast<std::size_t>(width() * width() * width())) {
    scanTriangles(surface.points, surface.triangles, separation, [&](const VoxelBlock& block) {
      forEachVoxel(block, [&](int x, int y, int z) {
        if (holds(x, y, z)) active_[slot(x, y, z)] = true;
      });
    });
  }

  bool holds(int x, int y, int z) const {
    return std::max({std::abs(x), std::abs(y), std::abs(z)}) <= side_;
  }
  bool active(int x, int y, int z) const { return active_[slot(x, y, z)]; }

  /// Calls visit(x, y, z) for each inactive voxel.
  template <class Visit>
  void forInactive(Visit&& visit) const {
    for (int x = -side_; x <= side_; ++x)
      for (int y = -side_; y <= side_; ++y)
        for (int z = -side_; z <= side_; ++z)
          if (!active(x, y, z)) visit(x, y, z);
  }

  std::size_t activeCount() const {
    return static_cast<std::size_t>(std::count(active_.begin(), active_.end(), true));
  }

  /// Number of pairs of inactive neighbours (6 or 26) that are on different sides.
  template <class Side>
  std::size_t leaks(Separation separation, Side&& side) const {
    std::vector<bool> on(active_.size());
    forInactive([&](int x, int y, int z) { on[slot(x, y, z)] = side(x, y, z); });
    std::size_t leaks = 0;
    forInactive([&](int x, int y, int z) {
      for (int step = 0; step < 27; ++step) {
        const int dx = step / 9 - 1;
        const int dy = step / 3 % 3 - 1;
        const int dz = step % 3 - 1;
        if (separation == Separation::k6 && std::abs(dx) + std::abs(dy) + std::abs(dz) != 1)
          continue;
        if (!holds(x + dx, y + dy, z + dz) || active(x + dx, y + dy, z + dz)) continue;
        leaks += on[slot(x, y, z)] != on[slot(x + dx, y + dy, z + dz)];
      }
    });
    return leaks;
  }

 private:
  int width() const { return 2 * side_ + 1; }
  std::size_t slot(int x, int y, int z) const {
    return static_cast<std::size_t>(((x + side_) * width() + y + side_) * width() + z + side_);
  }

  int side_;
  std::vector<bool> active_;
};

/// Winding number of a closed surface around a point: its solid angle in spheres; 0 outside.
int winding(const Surface& surface, const Vec3d& at) {
  double angle = 0;
  for (const auto& triangle : surface.triangles) {
    const Vec3d a = surface.points[triangle[0]] - at;
    const Vec3d b = surface.points[triangle[1]] - at;
    const Vec3d c = surface.points[triangle[2]] - at;
    const double la = a.norm();
    const double lb = b.norm();
    const double lc = c.norm();
    angle += 2 * std::atan2(a.dot(b.cross(c)),
                            la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return static_cast<int>(std::lround(angle / (4 * std::numbers::pi)));
}

/// Sphere of radius 1 of 4^levels * 8 triangles, points shared.
Surface sphere(int levels) {
  Surface surface;
  surface.points = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  surface.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                       {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<Index, Index>, Index> middles;
    const auto middle = [&](Index a, Index b) {
      const auto [found, isNew] =
          middles.try_emplace(std::minmax(a, b), static_cast<Index>(surface.points.size()));
      if (isNew) surface.points.push_back((surface.points[a] + surface.points[b]).normalized());
      return found->second;
    };
    std::vector<std::array<Index, 3>> finer;
    for (const auto& [a, b, c] : surface.triangles) {
      const Index ab = middle(a, b);
      const Index bc = middle(b, c);
      const Index ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    surface.triangles = finer;
  }
  return surface;
}

}  // namespace

TEST_CASE("no path of inactive voxels passes a closed surface", "[voxelize][property]") {
  const Separation separation = GENERATE(Separation::k6, Separation::k26);
  std::mt19937 random(1);
  std::uniform_real_distribution<double> shift(-0.5, 0.5);
  std::size_t inside = 0;
  for (int i = 0; i < 15; ++i) {
    Surface surface;
    if (i % 3 == 0) surface = sphere(i % 4);
    if (i % 3 == 1) surface = fanned(test::torusGrid(8 + i, 6));
    if (i % 3 == 2) surface = fanned(subdivide(baseLevel(test::dodecahedron()), 1).mesh);
    double reach = 0;
    for (const Vec3d& p : surface.points) reach = std::max(reach, p.norm());
    const Vec3d centre(shift(random), shift(random), shift(random));
    for (Vec3d& p : surface.points) {
      p = centre + 9 / reach * p + Vec3d(shift(random), shift(random), shift(random));
      // Corners, faces and centres of voxels, so that ties are common.
      if (i % 2 == 0) p = (p * 2).array().round() / 2;
    }
    const Cube cube(surface, separation, 11);
    const auto side = [&](int x, int y, int z) {
      const bool in = winding(surface, Vec3d(x, y, z)) != 0;
      inside += in;
      return in;
    };
    CAPTURE(i);
    CHECK(cube.leaks(separation, side) == 0);
  }
  CHECK(inside > 5000);  // there is something to leak
}

TEST_CASE("no path of inactive voxels passes a plane", "[voxelize][property]") {
  const Separation separation = GENERATE(Separation::k6, Separation::k26);
  std::mt19937 random(2);
  std::uniform_int_distribution<int> component(-6, 6);
  for (int i = 0; i < 80; ++i) {
    // A plane through a point of the half-voxel lattice, across the cube; whole numbers throughout.
    const Vec3d normal(component(random), component(random), component(random));
    if (normal.norm() == 0) continue;
    const Vec3d point(component(random) / 4.0, component(random) / 4.0, component(random) / 4.0);
    Vec3d along = normal.cross(Vec3d(0, 0, 1));
    if (along.norm() == 0) along = Vec3d(1, 0, 0);
    const Vec3d across = normal.cross(along);
    Surface plane;
    const Vec3d a = 64 * along;
    const Vec3d b = 64 * across;
    plane.points = {point - a - b, point + a - b, point + a + b, point - a + b};
    plane.triangles = {{0, 1, 2}, {0, 2, 3}};
    const Cube cube(plane, separation, 7);
    CAPTURE(normal.transpose(), point.transpose());
    CHECK(cube.leaks(separation, [&](int x, int y, int z) {
      const double height = normal.dot(Vec3d(x, y, z) - point);
      if (height == 0) FAIL("an inactive centre in the plane");
      return height > 0;
    }) == 0);
  }
}

TEST_CASE("a 6-separating plane has one voxel per column of the axis that it faces",
          "[voxelize][golden]") {
  // Theory: the column's line meets the plane at one height, and that lies within half a voxel of
  // one centre; segments along the other axes meet the plane only nearer to the same centre.
  std::mt19937 random(3);
  std::uniform_real_distribution<double> slope(-1, 1);
  for (int i = 0; i < 50; ++i) {
    const double slopeX = slope(random);
    const double slopeY = slope(random);
    const double offset = slope(random);
    const auto height = [&](double x, double y) { return slopeX * x + slopeY * y + offset; };
    const double far = 100;
    Surface plane;
    for (const auto& [x, y] : {std::pair(-far, -far), {far, -far}, {far, far}, {-far, far}})
      plane.points.emplace_back(x, y, height(x, y));
    plane.triangles = {{0, 1, 2}, {0, 2, 3}};
    constexpr int kSide = 20;
    const Cube cube(plane, Separation::k6, 2 * kSide + 2);
    for (int x = -kSide; x <= kSide; ++x)
      for (int y = -kSide; y <= kSide; ++y) {
        int active = 0;
        for (int z = -2 * kSide - 2; z <= 2 * kSide + 2; ++z)
          if (cube.active(x, y, z)) {
            ++active;
            CHECK(std::abs(z - height(x, y)) < 0.5 + 1e-4);  // corners are snapped
          }
        CHECK(active == 1);
      }
  }
}

TEST_CASE(
    "the voxels of a plane number its area times the 1-norm (26) or max-norm (6) of its normal",
    "[voxelize][golden]") {
  // Theory: the centres whose cube (or segment) meets the plane are in a layer of this thickness.
  const Vec3d normal = Vec3d(0.31, -0.53, 0.79).normalized();
  const Vec3d along = normal.unitOrthogonal();
  const Vec3d across = normal.cross(along);
  const double side = 400;
  const auto at = [&](double s, double t) { return Vec3d(side * (s * along + t * across)); };
  const Surface plane = {{at(-0.5, -0.5), at(0.5, -0.5), at(0.5, 0.5), at(-0.5, 0.5)},
                         {{0, 1, 2}, {0, 2, 3}}};
  const double area = side * side;
  const double tolerance = 4 * side;  // the rim
  for (const auto& [separation, thickness] : {std::pair(Separation::k26, normal.lpNorm<1>()),
                                              {Separation::k6, normal.lpNorm<Eigen::Infinity>()}}) {
    const Cube cube(plane, separation, 300);
    CHECK(static_cast<double>(cube.activeCount()) ==
          Approx(area * thickness).margin(2 * tolerance));
  }
}

TEST_CASE("the voxels of a sphere number 6 pi r^2 (26) or 12 sqrt(2) atan(1 / sqrt(2)) r^2 (6)",
          "[voxelize][golden]") {
  // Theory: the integrals of the 1-norm and the max-norm of the normal over the sphere.
  const double radius = 60.3;
  Surface surface = sphere(5);
  for (Vec3d& p : surface.points) p = radius * p + Vec3d(0.2, 0.1, -0.3);
  const double square = radius * radius;
  const double six = 12 * std::numbers::sqrt2 * std::atan(1 / std::numbers::sqrt2) * square;
  // The polyhedron is flatter than the sphere by 1e-3; the rest is the roundness of the count.
  CHECK(static_cast<double>(Cube(surface, Separation::k26, 63).activeCount()) ==
        Approx(6 * std::numbers::pi * square).epsilon(5e-3));
  CHECK(static_cast<double>(Cube(surface, Separation::k6, 63).activeCount()) ==
        Approx(six).epsilon(5e-3));
}
