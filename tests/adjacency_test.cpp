#include "libvox/mesh/adjacency.h"

#include "libvox/core/parallel.h"
#include "tests/shapes.h"

#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>
#include <catch2/catch.hpp>

#include <algorithm>

using namespace vox;

namespace {

/// OpenMesh's half-edge structure of the same mesh, an independent implementation of adjacency.
OpenMesh::PolyMesh_ArrayKernelT<> halfEdges(const PolygonMesh& mesh) {
  OpenMesh::PolyMesh_ArrayKernelT<> out;
  for (Index v = 0; v < mesh.pointCount(); ++v) out.add_vertex({0, 0, 0});
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    std::vector<OpenMesh::VertexHandle> face;
    for (const Index v : mesh.face(f)) face.emplace_back(static_cast<int>(v));
    REQUIRE(out.add_face(face).is_valid());
  }
  return out;
}

}  // namespace

TEST_CASE("twins agree with OpenMesh's half-edges", "[mesh]") {
  for (const auto& shape : test::shapes()) {
    if (shape.name == "bow tie") continue;  // OpenMesh links its fans into one
    CAPTURE(shape.name);
    const PolygonMesh& mesh = shape.mesh;
    const Adjacency adjacency = buildAdjacency(mesh);
    const auto oracle = halfEdges(mesh);
    for (Index c = 0; c < mesh.cornerCount(); ++c) {
      const Index from = mesh.faceVertices[c];
      const Index to = mesh.faceVertices[nextCorner(mesh, adjacency, c)];
      const auto halfedge = oracle.find_halfedge(OpenMesh::VertexHandle(static_cast<int>(from)),
                                                 OpenMesh::VertexHandle(static_cast<int>(to)));
      const auto across = oracle.face_handle(oracle.opposite_halfedge_handle(halfedge));
      const Index t = adjacency.twin[c];
      REQUIRE((t != kNone) == across.is_valid());
      if (t == kNone) continue;
      CHECK(adjacency.cornerFace[t] == static_cast<Index>(across.idx()));
      CHECK(mesh.faceVertices[t] == to);
      CHECK(adjacency.twin[t] == c);
    }
  }
}

TEST_CASE("a one-ring holds the faces around its point, counter-clockwise", "[mesh]") {
  for (const auto& shape : test::shapes()) {
    if (shape.name == "bow tie") continue;
    CAPTURE(shape.name);
    const PolygonMesh& mesh = shape.mesh;
    const Adjacency adjacency = buildAdjacency(mesh);
    const auto oracle = halfEdges(mesh);
    for (Index c = 0; c < mesh.cornerCount(); ++c) {
      const OneRing ring = oneRing(mesh, adjacency, c);
      const OpenMesh::VertexHandle vertex(static_cast<int>(mesh.faceVertices[c]));
      std::vector<Index> expected;
      for (const auto face : oracle.vf_ccw_range(vertex))
        expected.push_back(static_cast<Index>(face.idx()));
      std::vector<Index> faces;
      for (const Index k : ring.corners) faces.push_back(adjacency.cornerFace[k]);
      REQUIRE(faces.size() == expected.size());
      CHECK(ring.closed == !oracle.is_boundary(vertex));
      // OpenMesh may start anywhere on a closed ring.
      std::rotate(expected.begin(), std::find(expected.begin(), expected.end(), faces[0]),
                  expected.end());
      CHECK(faces == expected);
    }
  }
}

TEST_CASE("a bow-tie point has a ring for each of its fans", "[mesh]") {
  const PolygonMesh mesh = test::bowTie();
  const Adjacency adjacency = buildAdjacency(mesh);
  CHECK(oneRing(mesh, adjacency, 0).corners.size() == 3);
  CHECK(oneRing(mesh, adjacency, 0).closed);
}

TEST_CASE("boundary loops follow the rim", "[mesh]") {
  const PolygonMesh sheet = test::sheet(5, 4);
  const auto loops = boundaryLoops(sheet, buildAdjacency(sheet));
  REQUIRE(loops.size() == 1);
  CHECK(loops[0].size() == 18);  // 2 (5 + 4)

  const Adjacency adjacency = buildAdjacency(sheet);
  for (std::size_t i = 0; i < loops[0].size(); ++i) {
    const Index c = loops[0][i];
    const Index following = loops[0][(i + 1) % loops[0].size()];
    CHECK(adjacency.twin[c] == kNone);
    CHECK(sheet.faceVertices[nextCorner(sheet, adjacency, c)] == sheet.faceVertices[following]);
  }
}

TEST_CASE("a closed mesh has no boundary loop, a tube has two", "[mesh]") {
  const PolygonMesh torus = test::torusGrid(6, 4);
  CHECK(boundaryLoops(torus, buildAdjacency(torus)).empty());

  PolygonMesh tube = test::prism(6);  // without its two caps
  tube.faceVertices.erase(tube.faceVertices.begin(), tube.faceVertices.begin() + 12);
  tube.faceOffsets = {0, 4, 8, 12, 16, 20, 24};
  const auto loops = boundaryLoops(tube, buildAdjacency(tube));
  REQUIRE(loops.size() == 2);
  CHECK(loops[0].size() == 6);
  CHECK(loops[1].size() == 6);
}

TEST_CASE("edges of three faces or of equal direction separate their faces", "[mesh]") {
  const PolygonMesh fan = test::meshOf({{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}},
                                       {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}});
  CHECK(buildAdjacency(fan).twin == std::vector<Index>(9, kNone));

  const PolygonMesh flipped =
      test::meshOf({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 3, 2}});
  CHECK(buildAdjacency(flipped).twin == std::vector<Index>(6, kNone));
}

TEST_CASE("adjacency does not depend on the number of threads", "[mesh][parallel]") {
  const PolygonMesh mesh = test::shuffled(test::torusGrid(150, 100), 1);
  const auto build = [&] { return buildAdjacency(mesh).twin; };
  CHECK(onThreads(1, build) == onThreads(8, build));
}
