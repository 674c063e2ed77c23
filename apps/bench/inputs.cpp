// Generated meshes. Spheres are made from an octahedron with n^2 triangles on each face; its points
// are the integer points with |x| + |y| + |z| = n.

#include "apps/bench/inputs.h"

#include "libvox/core/error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <random>
#include <string>
#include <utility>

namespace vox::bench {
namespace {

constexpr double kTau = 2 * std::numbers::pi;

using Face = std::vector<Index>;

Vec3d onCircle(Index i, Index n, double radius, double z) {
  const double angle = kTau * i / n;
  return {radius * std::cos(angle), radius * std::sin(angle), z};
}

void addRing(PolygonMesh& mesh, Index n, double radius, double z) {
  for (Index i = 0; i < n; ++i) mesh.points.push_back(onCircle(i, n, radius, z));
}

/// Adds n quads between two circles of n points, given by their first points. Seen from outside,
/// `low` is below `high`.
void joinRings(PolygonMesh& mesh, Index n, Index low, Index high) {
  for (Index i = 0; i < n; ++i) {
    const Index next = (i + 1) % n;
    mesh.addFace(Face{low + i, low + next, high + next, high + i});
  }
}

/// Adds the n-gon of a circle of points, given by its first point; it faces up or down.
void addCap(PolygonMesh& mesh, Index n, Index first, bool fromAbove) {
  Face face(n);
  std::iota(face.begin(), face.end(), first);
  if (!fromAbove) std::reverse(face.begin(), face.end());
  mesh.addFace(face);
}

PolygonMesh torus() {
  constexpr Index kMajor = 64;
  constexpr Index kMinor = 32;
  PolygonMesh mesh;
  for (Index i = 0; i < kMajor; ++i)
    for (Index j = 0; j < kMinor; ++j) {
      const Vec3d section = onCircle(j, kMinor, 0.4, 0);
      mesh.points.push_back(onCircle(i, kMajor, 1 + section.x(), section.y()));
    }
  const auto at = [](Index i, Index j) { return i % kMajor * kMinor + j % kMinor; };
  for (Index i = 0; i < kMajor; ++i)
    for (Index j = 0; j < kMinor; ++j)
      mesh.addFace(Face{at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)});
  return mesh;
}

PolygonMesh cube() {
  PolygonMesh mesh;
  for (int i = 0; i < 8; ++i)
    mesh.points.emplace_back(i & 1 ? 1 : -1, i & 2 ? 1 : -1, i & 4 ? 1 : -1);
  for (const Face& face : {Face{0, 2, 3, 1}, Face{4, 5, 7, 6}, Face{0, 1, 5, 4}, Face{2, 6, 7, 3},
                           Face{0, 4, 6, 2}, Face{1, 3, 7, 5}})
    mesh.addFace(face);
  return mesh;
}

/// A unit sphere of 8 n^2 triangles and 4 n^2 + 2 points.
PolygonMesh octasphere(int n) {
  PolygonMesh mesh;
  std::map<std::array<int, 3>, Index> known;
  const auto pointAt = [&](std::array<int, 3> at) {
    const auto [entry, isNew] = known.try_emplace(at, mesh.pointCount());
    if (isNew) mesh.points.push_back(Vec3d(at[0], at[1], at[2]).normalized());
    return entry->second;
  };
  for (int octant = 0; octant < 8; ++octant) {
    const int sx = octant & 1 ? -1 : 1;
    const int sy = octant & 2 ? -1 : 1;
    const int sz = octant & 4 ? -1 : 1;
    const auto point = [&](int a, int b) { return pointAt({sx * a, sy * b, sz * (n - a - b)}); };
    const auto addTriangle = [&](Index p, Index q, Index r) {
      mesh.addFace(sx * sy * sz > 0 ? Face{p, q, r} : Face{p, r, q});
    };
    for (int a = 0; a < n; ++a)
      for (int b = 0; a + b < n; ++b) {
        addTriangle(point(a, b), point(a + 1, b), point(a, b + 1));
        if (a + b + 1 < n) addTriangle(point(a + 1, b), point(a + 1, b + 1), point(a, b + 1));
      }
  }
  return mesh;
}

/// Moves the points of a unit sphere in or out a little, without symmetry.
void addBumps(PolygonMesh& mesh) {
  for (Vec3d& p : mesh.points)
    p *= 1 + 0.05 * std::sin(7 * p.x() + 1) * std::sin(6 * p.y() + 2) * std::sin(5 * p.z() + 3);
}

/// Moves the points on the unit sphere towards +x: faces become small there, and large at -x.
void grade(PolygonMesh& mesh) {
  for (Vec3d& p : mesh.points) p = (p.normalized() + Vec3d(0.8, 0, 0)).normalized();
}

constexpr int kTrianglesSide = 112;  // 100 352 triangles

PolygonMesh triangles() {
  PolygonMesh mesh = octasphere(kTrianglesSide);
  addBumps(mesh);
  return mesh;
}

PolygonMesh trianglesGraded() {
  PolygonMesh mesh = octasphere(kTrianglesSide);
  grade(mesh);
  addBumps(mesh);
  return mesh;
}

/// The numbers 0..n-1 in random order; std::shuffle would depend on the standard library.
std::vector<Index> randomOrder(Index n, std::mt19937& random) {
  std::vector<Index> order(n);
  std::iota(order.begin(), order.end(), Index{0});
  for (Index i = n; i > 1; --i) std::swap(order[i - 1], order[random() % i]);
  return order;
}

PolygonMesh shuffled(const PolygonMesh& mesh) {
  std::mt19937 random(1);
  const std::vector<Index> newPoint = randomOrder(mesh.pointCount(), random);
  PolygonMesh shuffled;
  shuffled.points.resize(mesh.points.size());
  for (Index v = 0; v < mesh.pointCount(); ++v) shuffled.points[newPoint[v]] = mesh.points[v];
  for (const Index f : randomOrder(mesh.faceCount(), random)) {
    Face face;
    for (const Index v : mesh.face(f)) face.push_back(newPoint[v]);
    shuffled.addFace(face);
  }
  return shuffled;
}

PolygonMesh cone() {
  constexpr Index kSides = 2000;
  PolygonMesh mesh;
  addRing(mesh, kSides, 1, 0);
  mesh.points.emplace_back(0, 0, 1.5);
  for (Index i = 0; i < kSides; ++i) mesh.addFace(Face{i, (i + 1) % kSides, kSides});
  addCap(mesh, kSides, 0, false);
  return mesh;
}

PolygonMesh prism() {
  constexpr Index kSides = 5000;
  PolygonMesh mesh;
  addRing(mesh, kSides, 1, 0);
  addRing(mesh, kSides, 1, 1);
  joinRings(mesh, kSides, 0, kSides);
  addCap(mesh, kSides, 0, false);
  addCap(mesh, kSides, kSides, true);
  return mesh;
}

/// A bar of 1000 x 16 x 1. Each strip is a quad above and a quad below; the ends are quads, too.
PolygonMesh sliver() {
  constexpr double kLength = 1000;
  constexpr Index kStrips = 16;
  PolygonMesh mesh;
  for (Index y = 0; y <= kStrips; ++y)
    for (const double z : {0.0, 1.0})
      for (const double x : {0.0, kLength}) mesh.points.emplace_back(x, y, z);
  const auto at = [](Index x, Index y, Index z) { return 4 * y + 2 * z + x; };
  for (Index y = 0; y < kStrips; ++y) {
    mesh.addFace(Face{at(0, y, 1), at(1, y, 1), at(1, y + 1, 1), at(0, y + 1, 1)});
    mesh.addFace(Face{at(0, y, 0), at(0, y + 1, 0), at(1, y + 1, 0), at(1, y, 0)});
    mesh.addFace(Face{at(0, y, 0), at(0, y, 1), at(0, y + 1, 1), at(0, y + 1, 0)});
    mesh.addFace(Face{at(1, y, 0), at(1, y + 1, 0), at(1, y + 1, 1), at(1, y, 1)});
  }
  mesh.addFace(Face{at(0, 0, 0), at(1, 0, 0), at(1, 0, 1), at(0, 0, 1)});
  mesh.addFace(Face{at(0, kStrips, 0), at(0, kStrips, 1), at(1, kStrips, 1), at(1, kStrips, 0)});
  return mesh;
}

/// A spire of hexagons, each half as large as the one below; at 2^-20 the sides are 9.5e-7 long.
PolygonMesh graded() {
  constexpr Index kSides = 6;
  constexpr int kHalvings = 20;
  PolygonMesh mesh;
  for (int k = 0; k <= kHalvings; ++k) {
    const double radius = std::ldexp(1.0, -k);
    addRing(mesh, kSides, radius, 2 * (1 - radius));
    const Index ring = mesh.pointCount() - kSides;
    if (k > 0) joinRings(mesh, kSides, ring - kSides, ring);
  }
  addCap(mesh, kSides, 0, false);
  addCap(mesh, kSides, mesh.pointCount() - kSides, true);
  return mesh;
}

/// The mesh with every n-gon cut into n quads around its centroid.
PolygonMesh cutIntoQuads(const PolygonMesh& mesh) {
  PolygonMesh quads;
  quads.points = mesh.points;
  std::map<std::pair<Index, Index>, Index> middles;
  const auto middleOf = [&](Index v, Index w) {
    const auto [entry, isNew] = middles.try_emplace(std::minmax(v, w), quads.pointCount());
    if (isNew) quads.points.push_back((mesh.points[v] + mesh.points[w]) / 2);
    return entry->second;
  };
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    const auto face = mesh.face(f);
    const Index n = mesh.faceSize(f);
    Vec3d sum = Vec3d::Zero();
    for (const Index v : face) sum += mesh.points[v];
    const Index centre = quads.pointCount();
    quads.points.push_back(sum / n);
    for (Index i = 0; i < n; ++i)
      quads.addFace(Face{middleOf(face[(i + n - 1) % n], face[i]), face[i],
                         middleOf(face[i], face[(i + 1) % n]), centre});
  }
  return quads;
}

PolygonMesh quads() {
  PolygonMesh mesh = cutIntoQuads(octasphere(16));
  grade(mesh);
  addBumps(mesh);
  return mesh;
}

}  // namespace

PolygonMesh scan(int n) {
  const Index around = 2 * static_cast<Index>(n);
  PolygonMesh mesh;
  for (int i = 1; i < n; ++i)
    for (Index j = 0; j < around; ++j) {
      const double t = kTau / 2 * i / n;
      const double p = kTau * j / around;
      const double r = 1 + 0.08 * std::sin(7 * t) * std::cos(5 * p) +
                       0.02 * std::sin(31 * t + 0.3) * std::sin(29 * p) +
                       0.002 * std::sin(211 * t) * std::cos(173 * p);
      mesh.points.emplace_back(r * std::sin(t) * std::cos(p), r * std::sin(t) * std::sin(p),
                               r * std::cos(t));
    }
  mesh.points.emplace_back(0, 0, 1);
  mesh.points.emplace_back(0, 0, -1);
  for (Vec3d& point : mesh.points)
    for (double& x : point) x = static_cast<float>(x);
  const Index north = mesh.pointCount() - 2;
  const Index south = north + 1;
  const auto next = [&](Index j) { return (j + 1) % around; };
  for (Index j = 0; j < around; ++j) mesh.addFace(Face{north, j, next(j)});
  for (Index first = 0; first + around < north; first += around)
    for (Index j = 0; j < around; ++j) {
      const Index below = first + around;
      mesh.addFace(Face{first + j, below + j, below + next(j)});
      mesh.addFace(Face{first + j, below + next(j), first + next(j)});
    }
  const Index last = north - around;
  for (Index j = 0; j < around; ++j) mesh.addFace(Face{south, last + next(j), last + j});
  return mesh;
}

const std::vector<Input>& inputs() {
  static const std::vector<Input> all = {
      {"torus", "64 x 32 quads", torus},
      {"cube", "6 quads", cube},
      {"triangles", "bumpy sphere of 100352 triangles", triangles},
      {"triangles_shuffled", "the same in random order", [] { return shuffled(triangles()); }},
      {"triangles_graded", "as many, edges apart by about 10", trianglesGraded},
      {"cone", "apex of 2000 triangles over a 2000-gon", cone},
      {"prism", "two 5000-gons joined by quads", prism},
      {"sliver", "flat bar of strips, each 1000 times longer than wide", sliver},
      {"graded", "spire with faces from 1 down to 1e-6 in size", graded},
      {"quads", "6144 quads, points of valence 3 to 6, sizes apart by about 10", quads},
      {"scan_1m", "scan of 998000 triangles", [] { return scan(500); }, true},
      {"scan_4m", "scan of 3996000 triangles", [] { return scan(1000); }, true},
      {"scan_4m_shuffled", "the same in random order", [] { return shuffled(scan(1000)); }, true},
      {"scan_10m", "scan of 10233600 triangles", [] { return scan(1600); }, true},
  };
  return all;
}

PolygonMesh makeInput(std::string_view name) {
  for (const Input& input : inputs())
    if (input.name == name) return input.make();
  throw UsageError("no generated mesh is named '" + std::string(name) + "'");
}

}  // namespace vox::bench
