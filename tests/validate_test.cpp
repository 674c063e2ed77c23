#include "libvox/mesh/validate.h"

#include "libvox/core/error.h"
#include "tests/shapes.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <limits>

using namespace vox;
using Catch::Contains;

namespace {

std::vector<Defect> defectsOf(const PolygonMesh& mesh) {
  return findDefects(mesh, buildAdjacency(mesh));
}

void require(const PolygonMesh& mesh) {
  requireManifold(mesh, buildAdjacency(mesh));
}

}  // namespace

TEST_CASE("sound meshes have no defects and pass", "[mesh]") {
  for (const auto& shape : test::shapes()) {
    if (shape.name == "bow tie") continue;
    CAPTURE(shape.name);
    CHECK(defectsOf(shape.mesh).empty());
    CHECK_NOTHROW(require(shape.mesh));
  }
}

TEST_CASE("a bow tie is named and passes", "[mesh]") {
  const auto defects = defectsOf(test::bowTie());
  REQUIRE(defects.size() == 1);
  CHECK(defects[0].kind == DefectKind::kBowTieVertex);
  CHECK(defects[0].message == "vertex 0 joins 2 fans of faces");
  CHECK_NOTHROW(require(test::bowTie()));
}

TEST_CASE("winding makes no bow ties", "[mesh]") {
  for (const Defect& defect : defectsOf(test::stirred(test::dodecahedron(), 0.5, 2)))
    CHECK(defect.kind == DefectKind::kInconsistentWinding);
}

TEST_CASE("an unused vertex is named and passes", "[mesh]") {
  PolygonMesh mesh = test::cube();
  mesh.points.emplace_back(9, 9, 9);
  const auto defects = defectsOf(mesh);
  REQUIRE(defects.size() == 1);
  CHECK(defects[0].message == "vertex 8 belongs to no face");
  CHECK_NOTHROW(require(mesh));
}

TEST_CASE("a flipped face is refused by number", "[mesh][error]") {
  PolygonMesh mesh = test::cube();
  std::reverse(mesh.faceVertices.begin() + 8, mesh.faceVertices.begin() + 12);
  const auto defects = defectsOf(mesh);
  const auto edges = std::count_if(defects.begin(), defects.end(), [](const Defect& defect) {
    return defect.kind == DefectKind::kInconsistentWinding;
  });
  CHECK(edges == 4);
  CHECK_THROWS_WITH(require(mesh), Contains("and 2 run through edge") && Contains("3 more"));
}

TEST_CASE("an edge of three faces is refused by its vertices", "[mesh][error]") {
  const PolygonMesh fan = test::meshOf({{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}},
                                       {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}});
  CHECK_THROWS_WITH(require(fan), Contains("edge (0, 1) has 3 faces: 0, 1"));
}

TEST_CASE("a repeated corner is refused by face and vertex", "[mesh][error]") {
  const PolygonMesh mesh = test::meshOf({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 1, 2}});
  CHECK_THROWS_WITH(require(mesh), Contains("face 0 has vertex 1 at more than one corner"));
}

TEST_CASE("only the first defects of a kind are spelt out, all are counted", "[mesh]") {
  PolygonMesh mesh = test::cube();
  for (int i = 0; i < 20; ++i) mesh.points.emplace_back(9, 9, i);
  const auto defects = findDefects(mesh, buildAdjacency(mesh), 3);
  CHECK(defects.size() == 20);
  CHECK_FALSE(defects[2].message.empty());
  CHECK(defects[3].message.empty());
}

TEST_CASE("arrays that contradict themselves are refused by element", "[mesh][error]") {
  PolygonMesh range = test::cube();
  range.faceVertices[7] = 8;
  CHECK_THROWS_WITH(requireValidArrays(range), Contains("face 1 names vertex 8 of 8"));

  PolygonMesh digon = test::cube();
  digon.faceOffsets[1] = 2;
  CHECK_THROWS_WITH(requireValidArrays(digon), Contains("face 0 has fewer than 3 corners"));

  PolygonMesh offsets = test::cube();
  offsets.faceOffsets.back() = 23;
  CHECK_THROWS_WITH(requireValidArrays(offsets), Contains("faceOffsets"));

  PolygonMesh nan = test::cube();
  nan.points[3].y() = std::numeric_limits<double>::quiet_NaN();
  CHECK_THROWS_WITH(requireValidArrays(nan), Contains("vertex 3"));
}
