#include "libvox/prepare/crease.h"

#include "libvox/grid/openvdb.h"
#include "libvox/mesh/chaikin.h"
#include "libvox/pipeline/components.h"
#include "libvox/pipeline/convert.h"
#include "libvox/pipeline/refined_polygons.h"
#include "libvox/prepare/boundary.h"
#include "libvox/prepare/sound.h"
#include "libvox/subdivide/doo_sabin.h"
#include "libvox/subdivide/stop.h"
#include "tests/closest_point.h"
#include "tests/conversion.h"
#include "tests/reference.h"
#include "tests/scenes.h"
#include "tests/shapes.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <random>

using namespace vox;

namespace {

using Position = std::array<double, 3>;
Position positionOf(const Vec3d& p) {
  return {p.x(), p.y(), p.z()};
}

PolygonMesh sound(PolygonMesh mesh) {
  SoundReport report;
  return soundMesh(std::move(mesh), {}, report);
}

/// A sound mesh cut along edges that are chosen one by one.
template <class IsSharp>
CutMesh cutWhere(const PolygonMesh& mesh, IsSharp&& isSharp) {
  const Adjacency adjacency = buildAdjacency(mesh);
  SharpFeatures sharp = nothingSharp(mesh);
  for (Index c = 0; c < mesh.cornerCount(); ++c)
    if (adjacency.twin[c] != kNone && c < adjacency.twin[c] && isSharp(c))
      sharp.edges[c] = sharp.edges[adjacency.twin[c]] = true;
  return cutCreases(mesh, adjacency, sharp);
}

CutMesh cutByAngle(const PolygonMesh& mesh, double degrees) {
  const Adjacency adjacency = buildAdjacency(mesh);
  std::vector<Index> faces(mesh.faceCount());
  std::iota(faces.begin(), faces.end(), Index{0});
  SharpFeatures sharp = nothingSharp(mesh);
  markByAngle(mesh, adjacency, {{}, {}, faces}, degrees, sharp);
  return cutCreases(mesh, adjacency, sharp);
}

CutMesh cutAtRandom(const PolygonMesh& mesh, double share, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::bernoulli_distribution isSharp(share);
  return cutWhere(mesh, [&](Index) { return isSharp(random); });
}

SubdivisionLevel levelOf(const CutMesh& cut, double size = 1) {
  PolygonMesh mesh = cut.mesh;
  for (Vec3d& p : mesh.points) p *= size;
  SubdivisionLevel level = baseLevel(std::move(mesh));
  level.seam = cut.seam;
  return level;
}

/// Counts of directed edges, by the exact positions of their ends.
class EdgeBalance {
 public:
  void add(const Vec3d& from, const Vec3d& to) {
    const Position a = positionOf(from);
    const Position b = positionOf(to);
    if (a == b) return;
    ++(a < b ? balance_[{a, b}] : balance_[{b, a}]).at(a < b ? 0 : 1);
  }
  /// Number of edges that are not passed equally often in both directions.
  std::size_t open() const {
    return static_cast<std::size_t>(
        std::count_if(balance_.begin(), balance_.end(),
                      [](const auto& edge) { return edge.second[0] != edge.second[1]; }));
  }

 private:
  std::map<std::array<Position, 2>, std::array<int, 2>> balance_;
};

std::size_t openEdges(const PolygonMesh& mesh) {
  EdgeBalance edges;
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    const auto face = mesh.face(f);
    for (std::size_t i = 0; i < face.size(); ++i)
      edges.add(mesh.points[face[i]], mesh.points[face[(i + 1) % face.size()]]);
  }
  return edges.open();
}

/// Closed shapes with sharp edges of all kinds.
struct Creased {
  std::string name;
  CutMesh cut;
};
std::vector<Creased> creasedShapes() {
  std::vector<Creased> all;
  for (const auto& shape : test::shapes()) {
    if (!shape.closed) continue;
    const PolygonMesh mesh = sound(shape.mesh);
    for (const double degrees : {0.0, 20.0, 40.0, 60.0})
      all.push_back({shape.name + " by angle", cutByAngle(mesh, degrees)});
    for (const double share : {0.05, 0.2, 0.5})
      for (const std::uint32_t seed : {1U, 2U, 3U})
        all.push_back({shape.name + " at random", cutAtRandom(mesh, share, seed)});
  }
  return all;
}

}  // namespace

TEST_CASE("a cube with sharp edges stays that cube", "[prepare][crease]") {
  const CutMesh cut = cutByAngle(sound(test::cube()), 40);
  CHECK(cut.counts.sharpEdges == 12);
  CHECK(cut.counts.cornerVertices == 8);
  CHECK(cut.counts.darts == 0);
  CHECK(cut.mesh.faceCount() == 6);
  for (Index f = 0; f < 6; ++f) CHECK(cut.mesh.faceSize(f) == 8);
  const SubdivisionLevel level = subdivide(levelOf(cut), 5);
  std::size_t corners = 0;
  for (const Vec3d& p : level.mesh.points) {
    CHECK(std::abs(p.lpNorm<Eigen::Infinity>() - 1) < 1e-15);
    corners += p.cwiseAbs() == Vec3d(1, 1, 1) ? 1 : 0;
  }
  CHECK(corners >= 8);
}

TEST_CASE("an edge is sharp if its faces turn by more than the angle", "[prepare][crease]") {
  const PolygonMesh cube = sound(test::cube());
  CHECK(cutByAngle(cube, 89.9).counts.sharpEdges == 12);
  CHECK(cutByAngle(cube, 90).counts.sharpEdges == 0);
  CHECK(cutByAngle(cube, 180).counts.sharpEdges == 0);
  const PolygonMesh flat = sound(test::sheet(1, 1));
  CHECK(cutByAngle(flat, 0).seam.empty());
}

TEST_CASE("a mesh without sharp edges is not changed", "[prepare][crease]") {
  for (const auto& shape : test::shapes()) {
    const PolygonMesh mesh = sound(shape.mesh);
    const CutMesh cut = cutWhere(mesh, [](Index) { return false; });
    CHECK(cut.mesh.points == mesh.points);
    CHECK(cut.mesh.faceVertices == mesh.faceVertices);
    CHECK(cut.seam.empty());
  }
}

TEST_CASE("both sides of every crease have the same points", "[prepare][crease][property]") {
  for (const auto& shape : creasedShapes()) {
    CAPTURE(shape.name, shape.cut.counts.sharpEdges);
    SubdivisionLevel level = levelOf(shape.cut);
    CHECK(openEdges(level.mesh) == 0);
    for (int k = 1; k <= 3; ++k) {
      level = subdivide(std::move(level), 1);
      CHECK(openEdges(level.mesh) == 0);
    }
    const PolygonMesh joined = joinedAlongCreases(level.mesh, level.adjacency);
    CHECK(joined.faceCount() == level.mesh.faceCount());
    CHECK(openEdges(joined) == 0);
  }
}

TEST_CASE("polygons of mixed depths close along creases", "[prepare][crease][property]") {
  for (const auto& shape : creasedShapes()) {
    CAPTURE(shape.name, shape.cut.counts.sharpEdges);
    for (const StopRule& rule : {StopRule{.flatness = 0.05}, StopRule{.angle = 25.0},
                                 StopRule{.diameter = 3.0}, StopRule{.levels = 2}}) {
      Progress unwatched;
      const TriangleSoup soup =
          triangleSoup(levelOf(shape.cut, 8), rule, SurfaceOptions(), unwatched);
      EdgeBalance edges;
      for (const auto& triangle : soup.triangles)
        for (std::size_t i = 0; i < 3; ++i)
          edges.add(soup.points[triangle[i]], soup.points[triangle[(i + 1) % 3]]);
      CHECK(edges.open() == 0);
    }
  }
}

TEST_CASE("components go on across creases, and stay closed", "[prepare][crease]") {
  for (const auto& shape : test::shapes()) {
    const PolygonMesh mesh = sound(shape.mesh);
    const std::vector<MeshComponent> before = componentsOf(baseLevel(mesh));
    const std::vector<MeshComponent> after = componentsOf(levelOf(cutAtRandom(mesh, 0.3, 7)));
    REQUIRE(after.size() == before.size());
    for (std::size_t i = 0; i < after.size(); ++i) {
      CHECK(after[i].faces == before[i].faces);
      CHECK(after[i].side == before[i].side);
      CHECK((after[i].boundaryCorner == kNone) == (before[i].boundaryCorner == kNone));
    }
  }
}

TEST_CASE("the curve of a crease is the B-spline of its loop", "[prepare][crease]") {
  constexpr Index kSides = 7;
  const PolygonMesh prism = sound(test::prism(kSides));
  const Adjacency adjacency = buildAdjacency(prism);
  Index top = kNone;  // one of the two 7-gons
  for (Index f = 0; f < prism.faceCount() && top == kNone; ++f)
    if (prism.faceSize(f) == kSides) top = f;
  const auto ofTop = [&](Index c) {
    return adjacency.cornerFace[c] == top || adjacency.cornerFace[adjacency.twin[c]] == top;
  };
  const CutMesh cut = cutWhere(prism, ofTop);
  CHECK(cut.counts.sharpEdges == kSides);
  CHECK(cut.counts.cornerVertices == 0);
  std::vector<Vec3d> curve;
  for (const Index v : prism.face(top)) curve.push_back(prism.points[v]);
  SubdivisionLevel level = levelOf(cut);
  for (int k = 1; k <= 4; ++k) {
    level = subdivide(std::move(level), 1);
    std::vector<Vec3d> finer;
    for (std::size_t i = 0; i < curve.size(); ++i) {
      const Vec3d& next = curve[(i + 1) % curve.size()];
      finer.push_back(chaikin(curve[i], next));
      finer.push_back(chaikin(next, curve[i]));
    }
    curve = finer;
  }
  const auto loops = boundaryLoops(level.mesh, level.adjacency);
  REQUIRE(loops.size() == 2);
  for (const auto& loop : loops) {
    REQUIRE(loop.size() == curve.size());
    for (const Index c : loop) {
      const Vec3d& p = level.mesh.points[level.mesh.faceVertices[c]];
      double nearest = 1;
      for (const Vec3d& q : curve) nearest = std::min(nearest, (p - q).norm());
      CHECK(nearest < 1e-12);
    }
  }
}

TEST_CASE("a crease of one edge gets a vertex in its middle", "[prepare][crease]") {
  const PolygonMesh torus = sound(test::torusGrid(8, 6));
  const CutMesh cut = cutWhere(torus, [](Index c) { return c == 0; });
  CHECK(cut.counts.sharpEdges == 1);
  CHECK(cut.counts.darts == 2);
  CHECK(cut.mesh.pointCount() == torus.pointCount() + 2);
  CHECK(std::count(cut.pointOrigin.begin(), cut.pointOrigin.end(), torus.pointCount()) == 2);
  CHECK(openEdges(subdivide(levelOf(cut), 3).mesh) == 0);
}

TEST_CASE("the surface passes through a sharp vertex", "[prepare][crease]") {
  for (const auto& shape : test::shapes()) {
    CAPTURE(shape.name);
    const PolygonMesh mesh = sound(shape.mesh);
    const Adjacency adjacency = buildAdjacency(mesh);
    SharpFeatures sharp = nothingSharp(mesh);
    const Index v = mesh.faceVertices[0];
    sharp.vertices[v] = true;
    const CutMesh cut = cutCreases(mesh, adjacency, sharp);
    if (cut.counts.cornerVertices == 0) continue;  // between two faces
    const SubdivisionLevel level = subdivide(levelOf(cut), 3);
    CHECK(std::count(level.mesh.points.begin(), level.mesh.points.end(), mesh.points[v]) > 0);
  }
}

TEST_CASE("interpolated creases pass through their vertices, with the same bits on both sides",
          "[prepare][crease][property]") {
  for (const auto& shape : creasedShapes()) {
    CAPTURE(shape.name, shape.cut.counts.sharpEdges);
    const CutMesh& cut = shape.cut;
    PolygonMesh mesh = cut.mesh;
    const Adjacency adjacency = buildAdjacency(mesh);
    mesh = interpolateBoundary(std::move(mesh), adjacency, {cut.seam, cut.pointOrigin});
    CHECK(openEdges(mesh) == 0);
    for (const auto& loop : boundaryLoops(mesh, adjacency))
      for (std::size_t i = 0; i < loop.size(); ++i) {
        const auto at = [&](std::size_t k) { return mesh.faceVertices[loop[k % loop.size()]]; };
        const Vec3d onCurve = mesh.points[at(i + loop.size() - 1)] / 8.0 +
                              0.75 * mesh.points[at(i)] + mesh.points[at(i + 1)] / 8.0;
        const bool isCorner =
            cut.seam[loop[i]] == loop[i] || cut.seam[loop[(i + loop.size() - 1) % loop.size()]] ==
                                                loop[(i + loop.size() - 1) % loop.size()];
        const Vec3d& old = cut.mesh.points[at(i)];
        CHECK((isCorner ? (mesh.points[at(i)] - old).norm() : (onCurve - old).norm()) < 1e-12);
      }
  }
}

TEST_CASE("creased surfaces leave no tunnels", "[prepare][crease][property]") {
  for (const auto& shape : test::shapes()) {
    if (!shape.closed) continue;
    for (const std::uint32_t seed : {1U, 2U})
      for (const double size : {2.7, 6.1}) {
        CAPTURE(shape.name, seed, size);
        PolygonMesh mesh = sound(shape.mesh);
        for (Vec3d& p : mesh.points) p = p * size + Vec3d(0.13, 0.29, -0.41);
        const Adjacency adjacency = buildAdjacency(mesh);
        std::mt19937 random(seed);
        std::bernoulli_distribution isSharp(0.3);
        std::vector<PointPair> edges;
        const CutMesh cut = cutWhere(mesh, [&](Index c) {
          if (!isSharp(random)) return false;
          edges.push_back(
              {mesh.faceVertices[c], mesh.faceVertices[nextCorner(mesh, adjacency, c)]});
          return true;
        });
        SubdivisionLevel level = levelOf(cut);
        while (test::naiveLargestSpan(level.mesh) > 1) level = subdivide(std::move(level), 1);
        const PolygonMesh joined = joinedAlongCreases(level.mesh, level.adjacency);

        ConvertOptions options;
        options.voxelSize = 1;
        options.grids = std::vector{GridKind::kMask};
        options.smoothing.creaseEdges = edges;
        for (const auto& until : {std::optional<StopRule>(), std::optional(StopRule{.angle = 20.0}),
                                  std::optional(StopRule{.flatness = 0.1})}) {
          options.until = until;
          const Conversion conversion = convert(test::oneObject(mesh), options);
          CHECK(conversion.report.objects[0].creases.sharpEdges == cut.counts.sharpEdges);
          if (until && until->angle) continue;  // too far from the surface to be compared
          CHECK(test::sidesOf(joined, test::maskOf(conversion)).leaks == 0);
        }
      }
  }
}

TEST_CASE("level sets of meshes with all edges sharp are those of their polygons",
          "[level-set][crease]") {
  const auto surfaceOf = [](const PolygonMesh& mesh, double voxelSize, bool sharp) {
    ConvertOptions options;
    options.voxelSize = voxelSize;
    options.grids = std::vector{GridKind::kSurface};
    if (sharp)
      options.smoothing.crease = CreaseRule{.degrees = 0.0};
    else
      options.until = StopRule{.levels = 0};
    return openvdb::gridConstPtrCast<openvdb::FloatGrid>(
        openvdb::GridBase::ConstPtr(convert(test::oneObject(mesh), options).grids.at(0)));
  };
  const PolygonMesh hollow = test::together(test::cube(), test::cube(), {0, 0, 0}, 0.6);
  const PolygonMesh thin = [] {
    PolygonMesh mesh = test::cube();
    for (Vec3d& p : mesh.points) p.z() *= 0.02;
    return mesh;
  }();
  const PolygonMesh spike = [] {
    PolygonMesh mesh = test::pyramid(3);
    for (Vec3d& p : mesh.points) p.z() *= 4;
    return mesh;
  }();
  for (const PolygonMesh& mesh :
       {test::cube(), hollow, thin, spike, test::prism(5), test::tetrahedron()})
    for (const double voxelSize : {0.05, 0.0206186, 0.0333333}) {
      CAPTURE(mesh.pointCount(), voxelSize);
      const auto smooth = surfaceOf(mesh, voxelSize, true);
      const auto polygons = surfaceOf(mesh, voxelSize, false);
      const auto truth = polygons->getConstAccessor();
      const auto values = smooth->getConstAccessor();
      std::size_t wrong = 0;
      std::size_t missing = 0;
      for (auto it = smooth->cbeginValueOn(); it; ++it)
        wrong += std::abs(it.getValue() - truth.getValue(it.getCoord())) > 0.01 * voxelSize ? 1 : 0;
      for (auto it = polygons->cbeginValueOn(); it; ++it)
        missing += !values.isValueOn(it.getCoord()) && std::abs(it.getValue()) < 2.98 * voxelSize;
      CHECK(wrong == 0);
      CHECK(missing == 0);
    }
}

TEST_CASE("level sets of flat sheets with corners are those of their polygons",
          "[level-set][crease]") {
  const PolygonMesh square = test::regularPolygon(4);
  ConvertOptions options;
  options.smoothing.boundary = BoundaryRule::kCorners;
  options.grids = std::vector{GridKind::kSurface};
  for (const double voxelSize : {0.02, 0.033, 0.05}) {
    options.voxelSize = voxelSize;
    const Conversion conversion = convert(test::oneObject(square), options);
    const auto grid = openvdb::gridConstPtrCast<openvdb::FloatGrid>(
        openvdb::GridBase::ConstPtr(conversion.grids.at(0)));
    const test::ClosestPolygon truth(test::scaled(square, 1 / voxelSize));
    std::size_t wrong = 0;
    for (auto it = grid->cbeginValueOn(); it; ++it) {
      const openvdb::Coord at = it.getCoord();
      const double distance = truth.of(Vec3d(at.x(), at.y(), at.z())).distance;
      wrong += std::abs(it.getValue() / voxelSize - (distance - 0.5)) > 0.01 ? 1 : 0;
    }
    CHECK(grid->activeVoxelCount() > 0);
    CHECK(wrong == 0);
  }
}

TEST_CASE("normals of a polyhedron with sharp edges are those of its faces, also at corners",
          "[normals][crease]") {
  const PolygonMesh mesh = test::tetrahedron();
  std::vector<Vec3d> ofFaces;
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    const auto face = mesh.face(f);
    const auto at = [&](std::size_t i) { return mesh.points[face[i]]; };
    ofFaces.push_back((at(1) - at(0)).cross(at(2) - at(0)).normalized());
  }
  ConvertOptions options;
  options.grids = std::vector{GridKind::kNormal};
  options.smoothing.crease = CreaseRule{.degrees = 0.0};
  for (const int dim : {40, 61, 97}) {
    options.voxelSize = usedBox(mesh).longestSide() / dim;
    const Conversion conversion = convert(test::oneObject(mesh), options);
    const auto grid = openvdb::gridConstPtrCast<openvdb::Vec3SGrid>(
        openvdb::GridBase::ConstPtr(conversion.grids.at(0)));
    std::size_t wrong = 0;
    for (auto it = grid->cbeginValueOn(); it; ++it) {
      const openvdb::Vec3f n = it.getValue();
      double nearest = 2;
      for (const Vec3d& face : ofFaces)
        nearest = std::min(nearest, (Vec3d(n[0], n[1], n[2]) - face).norm());
      wrong += nearest > 1e-3 ? 1 : 0;
    }
    CHECK(grid->activeVoxelCount() > 0);
    CHECK(wrong == 0);
  }
}

TEST_CASE("a sharp tube far thinner than a voxel has few voxels", "[crease][level-set]") {
  PolygonMesh tube = test::prism(400);
  for (Vec3d& p : tube.points) p = p.cwiseProduct(Vec3d(2e-4, 2e-4, 1));
  ConvertOptions options;
  options.voxelSize = 1;
  options.grids = std::vector{GridKind::kSurface, GridKind::kNormal};
  options.smoothing.crease = CreaseRule{.degrees = 30.0};
  const Conversion conversion = convert(test::oneObject(tube), options);
  for (const auto& grid : conversion.grids) CHECK(grid->activeVoxelCount() < 1000);
}

TEST_CASE("an L with sharp edges is that L, whatever the length of its legs", "[crease][solid]") {
  for (const double leg : {1.1, 1.5, 3.0}) {
    PolygonMesh profile;
    for (const double z : {0.0, 1.0})
      for (const auto& [x, y] :
           {std::pair(0.0, 0.0), {leg, 0.0}, {leg, 1.0}, {1.0, 1.0}, {1.0, leg}, {0.0, leg}})
        profile.points.push_back({x, y, z});
    profile.addFace(std::array<Index, 6>{5, 4, 3, 2, 1, 0});
    profile.addFace(std::array<Index, 6>{6, 7, 8, 9, 10, 11});
    for (Index i = 0; i < 6; ++i) {
      const Index next = (i + 1) % 6;
      profile.addFace(std::array<Index, 4>{i, next, next + 6, i + 6});
    }
    ConvertOptions options;
    options.voxelSize = leg / 41;
    options.grids = std::vector{GridKind::kSurface};
    options.smoothing.crease = CreaseRule{.degrees = 40.0};
    const Conversion sharp = convert(test::oneObject(profile), options);
    options.smoothing.crease = {};
    options.until = StopRule{.levels = 0};
    const Conversion flat = convert(test::oneObject(profile), options);
    const auto treeOf = [](const Conversion& conversion) -> const openvdb::FloatTree& {
      return dynamic_cast<const openvdb::FloatGrid&>(*conversion.grids.at(0)).tree();
    };
    double most = 0;
    for (auto voxel = treeOf(flat).cbeginValueOn(); voxel; ++voxel)
      most = std::max(most, std::abs(double{*voxel} - treeOf(sharp).getValue(voxel.getCoord())));
    CHECK(most / *options.voxelSize < 0.01);
  }
}
