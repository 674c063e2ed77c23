#include "libvox/prepare/repair.h"

#include "libvox/core/error.h"
#include "libvox/mesh/spatial_order.h"
#include "libvox/prepare/chord.h"
#include "libvox/prepare/face_order.h"
#include "libvox/prepare/manifold.h"
#include "libvox/prepare/orient.h"
#include "libvox/prepare/weld.h"
#include "libvox/subdivide/doo_sabin.h"
#include "tests/shapes.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <random>

using namespace vox;
using Catch::Contains;

namespace {

struct Repaired {
  PolygonMesh mesh;
  RepairReport report;
  std::size_t count(RepairKind kind) const { return report[kind].count; }
};

Repaired repaired(const PolygonMesh& mesh, RepairOptions options = {}) {
  Repaired out;
  out.mesh = repair(mesh, options, out.report);
  CHECK(out.report.joints.twin == joinFaces(out.mesh, CrowdedEdge::kSeparate).adjacency.twin);
  return out;
}

PolygonMesh orientedMesh(const PolygonMesh& mesh) {
  OrientReport report;
  return orient(mesh, report);
}

/// Checks that the mesh, once oriented, has no defects and no interior vertex of two faces.
void checkRepaired(const PolygonMesh& mesh) {
  const PolygonMesh ready = orientedMesh(mesh);
  CHECK(test::faultOf(ready) == "");
  const Adjacency adjacency = buildAdjacency(ready);
  for (Index c = 0; c < ready.cornerCount(); ++c) {
    const Index valence =
        ledOneRingSize(ready, adjacency, c);  // 0 but for the first of a closed ring
    if (valence == 1 || valence == 2) FAIL_CHECK("corner " << c << " has a short ring");
  }
}

OrientReport componentsOf(const PolygonMesh& mesh) {
  OrientReport report;
  orient(mesh, report);
  return report;
}

}  // namespace

TEST_CASE("a sound mesh passes unchanged and nothing is reported", "[repair]") {
  for (const auto& shape : test::shapes()) {
    if (shape.name == "bow tie" || shape.name == "point of valence 2") continue;
    CAPTURE(shape.name);
    const auto out = repaired(shape.mesh);
    PolygonMesh same = shape.mesh;
    startFacesAtLowest(same);
    CHECK(test::sameMesh(out.mesh, same));
    CHECK_FALSE(out.report.changed());
    CHECK(summary(out.report).empty());
    checkRepaired(out.mesh);
  }
}

TEST_CASE("an unwelded cube welds to eight vertices and closes", "[repair][weld]") {
  PolygonMesh mesh = test::unwelded(test::cube());
  for (Vec3d& p : mesh.points) p += Vec3d(1, 1, 1);  // now it has zeros; some become -0
  for (std::size_t i = 0; i < mesh.points.size(); i += 2)
    for (double& x : mesh.points[i])
      if (x == 0) x = -0.0;

  const auto out = repaired(mesh);
  CHECK(out.mesh.pointCount() == 8);
  CHECK(out.count(RepairKind::kWeldedVertex) == 16);
  CHECK(summary(out.report) == "welded 16 vertices");
  CHECK(out.report[RepairKind::kWeldedVertex].message == "welded vertex 8 to vertex 0");
  CHECK(test::eulerCharacteristic(out.mesh) == 2);
  CHECK(componentsOf(out.mesh).closedComponents == 1);
  for (Index v = 0; v < 8; ++v) CHECK(out.mesh.points[v] == mesh.points[out.report.pointOrigin[v]]);
  checkRepaired(out.mesh);
}

TEST_CASE("a tolerance welds near points, without chains, and leaves the others",
          "[repair][weld]") {
  std::vector<Vec3d> points;
  for (int i = 0; i < 10; ++i) points.emplace_back(0.9 * i, -0.0, 0);
  const std::vector<std::uint8_t> used(10, true);
  CHECK(weldTargets(points, used, 1.0) == std::vector<Index>{0, 0, 2, 2, 4, 4, 6, 6, 8, 8});
  CHECK(weldTargets(points, used, 0.5) == std::vector<Index>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9});
  CHECK(weldTargets(points, used, 1e-310) == std::vector<Index>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9});
  CHECK(weldTargets(points, used, 1e300) == std::vector<Index>(10, 0));
  std::vector<std::uint8_t> firstUnused = used;
  firstUnused[0] = false;
  CHECK(weldTargets(points, firstUnused, 1.0)[1] == 1);
}

TEST_CASE("points that stay are further apart than the tolerance, the others within it",
          "[repair][weld][property]") {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> in(-1, 1);
  std::vector<Vec3d> points(600);
  for (Vec3d& p : points) p = Vec3d(in(random), in(random), in(random));
  const double tolerance = GENERATE(0.01, 0.2, 0.7);
  const auto target = weldTargets(points, std::vector<std::uint8_t>(600, true), tolerance);
  for (Index v = 0; v < 600; ++v) {
    Index expected = v;  // slow, obvious: the lowest point that stayed within the tolerance
    for (Index w = v; w-- > 0;)
      if (target[w] == w && (points[w] - points[v]).norm() <= tolerance) expected = w;
    CHECK(target[v] == expected);
  }
}

TEST_CASE("an invalid weld tolerance is refused", "[repair][weld][error]") {
  RepairReport report;
  CHECK_THROWS_AS(repair(test::cube(), {-1}, report), UsageError);
  CHECK_THROWS_AS(repair(test::cube(), {std::numeric_limits<double>::quiet_NaN()}, report),
                  UsageError);
}

TEST_CASE("a mesh within the tolerance vanishes without a crash", "[repair][weld]") {
  const auto out = repaired(test::cube(), {10});
  CHECK(out.mesh.faceCount() == 0);
  CHECK(out.mesh.pointCount() == 0);
  CHECK(out.count(RepairKind::kDegenerateFace) == 6);
  CHECK(orientedMesh(out.mesh).faceCount() == 0);
}

TEST_CASE("repeats and spikes leave their face, thin faces go", "[repair]") {
  const PolygonMesh mesh = test::meshOf({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {2, 2, 0}},
                                        {{0, 1, 1, 2, 4, 2, 3, 0}, {0, 4, 0}, {1, 1, 1}});
  const auto out = repaired(mesh);
  CHECK(out.mesh.faceCount() == 1);
  CHECK(out.mesh.faceVertices == std::vector<Index>{0, 1, 2, 3});
  CHECK(out.count(RepairKind::kRepeatedCorner) == 1);
  CHECK(out.count(RepairKind::kDegenerateFace) == 2);
  CHECK(out.report[RepairKind::kDegenerateFace].element == 1);
  CHECK(out.count(RepairKind::kRemovedVertex) == 1);
  CHECK(
      summary(out.report) ==
      "removed repeated corners from 1 face, dropped 2 degenerate faces, removed 1 unused vertex");
  checkRepaired(out.mesh);
}

TEST_CASE("a figure eight becomes two faces that no longer touch", "[repair]") {
  const PolygonMesh mesh = test::meshOf({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {-1, 0, 0}, {-1, -1, 0}},
                                        {{0, 1, 2, 0, 3, 4}});
  const auto out = repaired(mesh);
  CHECK(out.mesh.faceCount() == 2);
  CHECK(out.mesh.pointCount() == 6);
  CHECK(out.count(RepairKind::kSplitFace) == 1);
  CHECK(out.count(RepairKind::kSplitVertex) == 1);
  CHECK(out.report.faceOrigin == std::vector<Index>{0, 0});
  CHECK(out.report.pointOrigin == std::vector<Index>{0, 1, 2, 3, 4, 0});
  checkRepaired(out.mesh);
}

TEST_CASE("a keyhole becomes faces around its hole, which is no repair", "[repair]") {
  PolygonMesh mesh;
  for (const double r : {3.0, 1.0, 2.0})
    for (const Vec3d& p : test::regularPolygon(4).points) mesh.points.push_back(r * p);
  mesh.addFace(std::vector<Index>{0, 1, 2, 3, 0, 8, 4, 7, 6, 5, 4, 8});
  mesh.points.resize(9);
  const auto out = repaired(mesh);
  CHECK(out.mesh.faceCount() == 4);
  CHECK(out.report.faceOrigin == std::vector<Index>(4, 0));
  CHECK(out.mesh.pointCount() == 8);  // without the vertex on the bridge
  CHECK_FALSE(out.report.changed());
  CHECK(summary(out.report.faces) == "split 1 face with holes into 4");
  checkRepaired(out.mesh);
}

TEST_CASE("of duplicate faces the first stays, whatever their winding and start", "[repair]") {
  PolygonMesh mesh = test::cube();
  mesh.addFace(std::vector<Index>{3, 1, 0, 2});
  mesh.addFace(std::vector<Index>{3, 2, 0, 1});
  mesh.addFace(std::vector<Index>{0, 3, 2, 1});  // same vertices, another cycle: not a duplicate
  const auto out = repaired(mesh);
  CHECK(out.count(RepairKind::kDuplicateFace) == 2);
  CHECK(out.report[RepairKind::kDuplicateFace].message == "dropped face 6, which repeats face 0");
  CHECK(out.mesh.faceCount() == 7);
  checkRepaired(out.mesh);
}

TEST_CASE("faces without area stay", "[repair]") {
  PolygonMesh mesh = test::sheet(2, 2);
  for (Vec3d& p : mesh.points) p = Vec3d(p.x(), 0, 0);
  for (std::size_t v = 0; v < mesh.points.size(); ++v) mesh.points[v].x() += 0.1 * double(v);
  // Without welding: all vertices lie on one line, and would be stitched.
  CHECK(test::sameMesh(repaired(mesh, {.weld = false}).mesh, mesh));
}

TEST_CASE("two tetrahedra that share a vertex come apart there", "[repair]") {
  const auto out = repaired(test::bowTie());
  CHECK(out.mesh.pointCount() == 8);
  CHECK(out.report.pointOrigin.list().back() == 0);
  CHECK(summary(out.report) == "split 1 vertex");
  CHECK(out.report[RepairKind::kSplitVertex].message ==
        "split vertex 0, which joins several fans of faces");
  CHECK(test::eulerCharacteristic(out.mesh) == 4);
  checkRepaired(out.mesh);
}

TEST_CASE("a shared apex of two cones comes apart", "[repair]") {
  const auto out = repaired(test::twoCones());
  CHECK(out.mesh.pointCount() == 14);
  CHECK(componentsOf(out.mesh).openComponents == 2);
  checkRepaired(out.mesh);
}

TEST_CASE("an edge of three faces keeps the flattest two joined", "[repair]") {
  // A plate of two quads, folded by `lift`, and a fin; in every order and winding of the faces.
  const double lift = GENERATE(-0.3, 0.0, 0.3);
  std::vector<std::vector<Index>> faces = {{0, 1, 2, 3}, {1, 0, 5, 4}, {0, 1, 6, 7}};
  const int order = GENERATE(0, 1, 2);
  const int windings = GENERATE(range(0, 8));
  std::rotate(faces.begin(), faces.begin() + order, faces.end());
  PolygonMesh mesh;
  mesh.points = {{0, 0, 0},  {0, 1, 0},  {1, 1, lift}, {1, 0, lift},
                 {-1, 1, 0}, {-1, 0, 0}, {0, 1, 1},    {0, 0, 1}};
  for (int f = 0; f < 3; ++f) {
    if (windings >> f & 1) std::reverse(faces[f].begin(), faces[f].end());
    mesh.addFace(faces[f]);
  }
  const auto out = repaired(mesh);
  CHECK(out.mesh.faceCount() == 3);
  CHECK(out.mesh.pointCount() == 10);
  CHECK(summary(out.report) == "cut 1 edge");
  CHECK_THAT(out.report[RepairKind::kCutEdge].message, Contains("cut edge (0, 1) of face 0"));
  checkRepaired(out.mesh);

  const Index fin = static_cast<Index>((2 - order + 3) % 3);
  const Adjacency joints = joinFaces(out.mesh, CrowdedEdge::kSeparate).adjacency;
  for (Index c = 0; c < out.mesh.cornerCount(); ++c)
    if (joints.twin[c] != kNone) CHECK(joints.cornerFace[c] != fin);
  CHECK(componentsOf(out.mesh).components == 2);
}

TEST_CASE("a fin in the middle of a plate leaves the plate whole", "[repair]") {
  const PolygonMesh mesh = test::finOnSheet();
  const auto out = repaired(mesh);
  CHECK(out.count(RepairKind::kCutEdge) == 2);
  CHECK(out.mesh.pointCount() == mesh.pointCount() + 3);
  CHECK(out.count(RepairKind::kSplitVertex) == 0);
  const auto components = componentsOf(out.mesh);
  CHECK(components.openComponents == 2);
  CHECK(components.components == 2);
  checkRepaired(out.mesh);
}

TEST_CASE("two cubes that touch along an edge stay two closed cubes", "[repair]") {
  const PolygonMesh mesh = test::together(test::cube(), test::cube(), {2, 2, 0});
  const auto out = repaired(mesh);
  CHECK(out.count(RepairKind::kCutEdge) == 1);
  CHECK(out.mesh.pointCount() == 16);
  CHECK(componentsOf(out.mesh).closedComponents == 2);
  checkRepaired(out.mesh);
}

TEST_CASE("two cubes with a common wall become a closed box and the wall", "[repair]") {
  const auto out = repaired(test::together(test::cube(), test::cube(), {2, 0, 0}));
  CHECK(out.count(RepairKind::kDuplicateFace) == 1);
  CHECK(out.count(RepairKind::kCutEdge) == 4);
  const auto components = componentsOf(out.mesh);
  CHECK(components.closedComponents == 1);
  CHECK(components.openComponents == 1);
  checkRepaired(out.mesh);
}

TEST_CASE("back-to-back faces become one, a flat box too", "[repair]") {
  const PolygonMesh pillow =
      test::meshOf({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 1}});
  CHECK(repaired(pillow).mesh.faceCount() == 1);
}

TEST_CASE("an interior vertex of two faces is chorded, chains of them too", "[repair][chord]") {
  const auto one = repaired(test::valenceTwo());
  CHECK(test::sameMesh(one.mesh, [] {
    PolygonMesh cube = test::cube();
    for (Index f = 0; f < 6; ++f) {
      auto begin = cube.faceVertices.begin() + 4 * f;
      const auto first = test::valenceTwo().face(f)[0];
      std::rotate(begin, std::find(begin, begin + 4, first), begin + 4);
    }
    return cube;
  }()));
  CHECK(summary(one.report) == "chorded 1 vertex");
  CHECK(one.report[RepairKind::kChordedVertex].element == 8);

  // A tetrahedron with a chain of 1000 vertices along one edge.
  PolygonMesh chain = test::tetrahedron();
  std::vector<Index> there;
  for (int i = 1; i <= 1000; ++i) {
    there.push_back(chain.pointCount());
    chain.points.push_back(chain.points[0] + (chain.points[1] - chain.points[0]) * i / 1001.0);
  }
  PolygonMesh mesh;
  mesh.points = chain.points;
  for (Index f = 0; f < 4; ++f) {
    std::vector<Index> face;
    for (std::size_t i = 0; i < 3; ++i) {
      const Index a = chain.face(f)[i];
      const Index b = chain.face(f)[(i + 1) % 3];
      face.push_back(a);
      if (a == 0 && b == 1) face.insert(face.end(), there.begin(), there.end());
      if (a == 1 && b == 0) face.insert(face.end(), there.rbegin(), there.rend());
    }
    mesh.addFace(face);
  }
  const auto out = repaired(mesh);
  CHECK(out.count(RepairKind::kChordedVertex) == 1000);
  CHECK(test::sameMesh(orientedMesh(out.mesh), orientedMesh(test::tetrahedron())));
}

TEST_CASE("a face that chords leave with two corners closes up", "[repair][chord]") {
  // Tetrahedron with face (0, 1, 2) cut into a triangle (0, 1, 4) and a dart (0, 4, 1, 2): vertex 4
  // has two faces. Without it the triangle is the edge (0, 1).
  PolygonMesh mesh = test::tetrahedron();
  PolygonMesh cut;
  cut.points = mesh.points;
  cut.points.push_back((mesh.points[0] + mesh.points[1] + mesh.points[2]) / 3);
  cut.addFace(std::vector<Index>{0, 1, 4});
  cut.addFace(std::vector<Index>{0, 4, 1, 2});
  for (Index f = 1; f < 4; ++f) cut.addFace(mesh.face(f));
  const auto out = repaired(cut);
  CHECK(out.count(RepairKind::kChordedVertex) == 1);
  CHECK(out.count(RepairKind::kCollapsedFace) == 1);
  CHECK(test::sameMesh(orientedMesh(out.mesh), orientedMesh(test::tetrahedron())));
}

TEST_CASE("a component that encloses nothing is dropped and counted", "[repair][chord]") {
  // A quad and its two halves, glued all around.
  const PolygonMesh flat = test::meshOf({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}},
                                        {{0, 1, 2, 3}, {0, 3, 2}, {0, 2, 1}});
  const auto out = repaired(test::together(test::cube(), flat, {9, 9, 9}));
  CHECK(out.count(RepairKind::kVanishedComponent) == 1);
  CHECK(out.count(RepairKind::kCollapsedFace) == 3);
  CHECK(test::sameMesh(out.mesh, test::cube()));
}

TEST_CASE("opening interior pairs is always possible", "[repair][chord]") {
  PolygonMesh mesh = test::valenceTwo();
  Adjacency joints = joinFaces(mesh, CrowdedEdge::kSeparate).adjacency;
  openInteriorPairs(mesh, joints);
  CHECK(splitFans(mesh, joints) == std::vector<Index>{8});
  checkRepaired(mesh);
}

TEST_CASE("boundary vertices of one or two faces stay", "[repair][chord]") {
  const PolygonMesh sheet = test::sheet(1, 3);
  CHECK(test::sameMesh(repaired(sheet).mesh, sheet));
}

TEST_CASE("the report names input elements, and says where the output comes from", "[repair]") {
  PolygonMesh mesh = test::cube();
  mesh.points.insert(mesh.points.begin(), 3, Vec3d(7, 7, 7));
  for (Index& v : mesh.faceVertices) v += 3;
  mesh.addFace(std::vector<Index>{3, 4, 3});
  mesh.addFace(std::vector<Index>{3, 5, 7});
  const auto out = repaired(mesh);
  CHECK(out.report[RepairKind::kRemovedVertex].count == 3);
  CHECK(out.report[RepairKind::kRemovedVertex].message ==
        "removed vertex 0, which belongs to no face");
  CHECK(out.report[RepairKind::kDegenerateFace].message ==
        "dropped face 6, which has fewer than 3 distinct corners");
  REQUIRE(out.report.faceOrigin.size() == out.mesh.faceCount());
  CHECK(out.report.faceOrigin.list().back() == 7);
  REQUIRE(out.report.pointOrigin.size() == out.mesh.pointCount());
  for (Index v = 0; v < out.mesh.pointCount(); ++v)
    CHECK(out.mesh.points[v] == mesh.points[out.report.pointOrigin[v]]);
}

TEST_CASE("arrays that contradict themselves are refused before repair", "[repair][error]") {
  PolygonMesh mesh = test::cube();
  mesh.faceVertices[7] = 8;
  RepairReport report;
  CHECK_THROWS_WITH(repair(mesh, {}, report), Contains("face 1 names vertex 8"));
}

TEST_CASE("mutated meshes end sound, repair is idempotent and repeatable", "[repair][property]") {
  const auto& shapes = test::shapes();
  for (std::uint32_t seed = 0; seed < 1200; ++seed) {
    CAPTURE(seed);
    std::mt19937 random(seed);
    PolygonMesh mesh = shapes[seed % shapes.size()].mesh;
    if (seed % 4 == 3) mesh = test::together(mesh, test::moebius(7), {0.5, 0.25, 0});
    const int mutations = 1 + static_cast<int>(random() % 12);
    for (int i = 0; i < mutations; ++i) test::mutate(mesh, random);

    const auto once = repaired(mesh, {seed % 3 == 0 ? 0.3 : 0.0});
    checkRepaired(once.mesh);
    CHECK(test::sameMesh(once.mesh, repaired(mesh, {seed % 3 == 0 ? 0.3 : 0.0}).mesh));

    // Split no more: whether a face that crosses itself can be split depends on vertex numbers.
    const auto twice = repaired(once.mesh, {0, false, FaceRule::kKeep});
    CHECK_FALSE(twice.report.changed());
    CHECK(summary(twice.report).empty());
    CHECK(test::sameMesh(twice.mesh, once.mesh));
  }
}

TEST_CASE(
    "a large mesh in random order is put into spatial order, and its elements keep their names",
    "[repair]") {
  const PolygonMesh ordered = test::torusGrid(256, 300);
  CHECK_FALSE(isScattered(ordered));
  PolygonMesh mesh = test::shuffled(ordered, 7);
  CHECK(isScattered(mesh));
  mesh.addFace(mesh.face(5));  // a fault, to be named

  const auto out = repaired(mesh);
  CHECK_FALSE(isScattered(out.mesh));
  CHECK(out.count(RepairKind::kDuplicateFace) == 1);
  REQUIRE(out.mesh.faceCount() == ordered.faceCount());
  REQUIRE(out.mesh.pointCount() == ordered.pointCount());
  bool same = true;
  for (Index v = 0; v < out.mesh.pointCount(); ++v)
    same &= out.mesh.points[v] == mesh.points[out.report.pointOrigin[v]];
  std::vector<bool> seen(mesh.faceCount(), false);
  for (Index f = 0; f < out.mesh.faceCount(); ++f) {
    std::vector<Index> face;
    for (const Index v : out.mesh.face(f)) face.push_back(out.report.pointOrigin[v]);
    std::vector<Index> original(mesh.face(out.report.faceOrigin[f]).begin(),
                                mesh.face(out.report.faceOrigin[f]).end());
    startAtLowest(face);
    startAtLowest(original);
    same &= face == original && !seen[out.report.faceOrigin[f]];
    seen[out.report.faceOrigin[f]] = true;
  }
  CHECK(same);
}

TEST_CASE("adversarial meshes of 100,000 elements are repaired", "[repair][property]") {
  // At quadratic cost, each would take minutes.
  const Index n = 100000;
  std::vector<PolygonMesh> hard;
  hard.push_back(test::book(static_cast<int>(n)));  // an edge of n faces
  hard.push_back(test::pyramid(static_cast<int>(n)));
  PolygonMesh flower;  // a vertex of n fans
  flower.points.emplace_back(0, 0, 0);
  PolygonMesh comb;  // a face of 4 n corners, all spikes
  comb.points = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
  std::vector<Index> spikes = {0, 1, 2};
  for (Index i = 0; i < n; ++i) {
    flower.points.emplace_back(i, 1, 0);
    flower.points.emplace_back(i, 1, 1);
    flower.addFace(std::vector<Index>{0, 2 * i + 1, 2 * i + 2});
    comb.points.emplace_back(i, 2, 0);
    spikes.insert(spikes.end(), {comb.pointCount() - 1, 2, 0, 2});
  }
  comb.addFace(spikes);
  hard.push_back(flower);
  hard.push_back(comb);
  for (const auto& mesh : hard) checkRepaired(repaired(mesh).mesh);
}
