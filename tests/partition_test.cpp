#include "libvox/localize/partition.h"

#include "libvox/core/parallel.h"
#include "tests/shapes.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <numeric>
#include <random>
#include <set>
#include <vector>

using namespace vox;

namespace {

PolygonMesh withFacesShuffled(const PolygonMesh& mesh) {
  std::vector<Index> order(mesh.faceCount());
  std::iota(order.begin(), order.end(), Index{0});
  std::shuffle(order.begin(), order.end(), std::mt19937(1));
  PolygonMesh shuffled;
  shuffled.points = mesh.points;
  for (const Index f : order) shuffled.addFace(mesh.face(f));
  return shuffled;
}

std::vector<Index> submeshOfFaces(const Partition& partition) {
  std::vector<Index> submesh(partition.faces.size(), kNone);
  for (Index s = 0; s < partition.size(); ++s)
    for (const Index f : partition.submesh(s)) {
      REQUIRE(submesh[f] == kNone);
      submesh[f] = s;
    }
  return submesh;
}

/// Share of the interior edges whose two faces lie in one submesh.
double innerPart(const Adjacency& adjacency, const std::vector<Index>& submesh) {
  double inner = 0;
  double all = 0;
  for (Index c = 0; c < static_cast<Index>(adjacency.twin.size()); ++c) {
    if (adjacency.twin[c] == kNone) continue;
    all += 1;
    const Index here = submesh[adjacency.cornerFace[c]];
    inner += here == submesh[adjacency.cornerFace[adjacency.twin[c]]] ? 1 : 0;
  }
  return inner / all;
}

}  // namespace

TEST_CASE("a cover holds each face once, in submeshes of bounded size", "[localize][property]") {
  for (const auto* shapes : {&test::shapes(), &test::openShapes()})
    for (const auto& shape : *shapes)
      for (const Index most : {0U, 1U, 2U, 7U, 64U, 100000U}) {
        CAPTURE(shape.name, most);
        const Adjacency adjacency = buildAdjacency(shape.mesh);
        const Partition partition = coverGreedily(shape.mesh, adjacency, most);
        REQUIRE(partition.faces.size() == shape.mesh.faceCount());
        submeshOfFaces(partition);
        for (Index s = 0; s < partition.size(); ++s) {
          CHECK(!partition.submesh(s).empty());
          CHECK(partition.submesh(s).size() <= 3 * std::max<std::size_t>(most, 1));
        }
      }
}

TEST_CASE("submeshes are compact for any order of the faces of a large mesh",
          "[localize][property]") {
  const PolygonMesh ordered = test::torusGrid(200, 200);
  constexpr Index kMost = 64;
  for (const bool shuffled : {false, true}) {
    CAPTURE(shuffled);
    const PolygonMesh mesh = shuffled ? withFacesShuffled(ordered) : ordered;
    const Adjacency adjacency = buildAdjacency(mesh);
    const Partition partition = coverGreedily(mesh, adjacency, kMost);
    const std::vector<Index> submesh = submeshOfFaces(partition);
    CHECK(partition.size() < 3 * mesh.faceCount() / kMost);
    // A square of 8 x 8 faces has 112 of its 128 edges within, counting those at its sides by half.
    CHECK(innerPart(adjacency, submesh) > 0.7);
  }
}

TEST_CASE("submeshes need little more than the mesh, even if thousands of faces meet",
          "[localize][property]") {
  constexpr int kFaces = 20000;
  const PolygonMesh cone = test::openFan(kFaces, 3);
  const PolygonMesh prism = test::prism(kFaces);
  for (const PolygonMesh* mesh : {&cone, &prism}) {
    const Partition partition = coverGreedily(*mesh, buildAdjacency(*mesh), 64);
    std::vector<std::vector<Index>> facesAt(mesh->pointCount());
    for (Index f = 0; f < mesh->faceCount(); ++f)
      for (const Index v : mesh->face(f)) facesAt[v].push_back(f);
    // Corners of all faces that share a vertex with one of the submesh.
    std::size_t needed = 0;
    for (Index s = 0; s < partition.size(); ++s) {
      std::set<Index> vertices, faces;
      for (const Index f : partition.submesh(s))
        for (const Index v : mesh->face(f))
          if (vertices.insert(v).second) faces.insert(facesAt[v].begin(), facesAt[v].end());
      for (const Index f : faces) needed += mesh->faceSize(f);
    }
    CHECK(needed < 32 * mesh->cornerCount());  // with submeshes of 64 faces, 300 times
    CHECK(partition.size() > 2);
  }
}

TEST_CASE("thread count never changes a cover", "[localize][parallel]") {
  const PolygonMesh mesh = withFacesShuffled(test::torusGrid(200, 200));
  const Adjacency adjacency = buildAdjacency(mesh);
  const Partition first = coverGreedily(mesh, adjacency, 64);
  for (const int threads : {1, 2, 8}) {
    const Partition other = onThreads(threads, [&] { return coverGreedily(mesh, adjacency, 64); });
    CHECK(other.faces == first.faces);
    CHECK(other.offsets == first.offsets);
  }
}
