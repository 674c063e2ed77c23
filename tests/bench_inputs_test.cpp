// The generated meshes of the benchmarks are what their names say.

#include "apps/bench/inputs.h"
#include "libvox/core/error.h"
#include "libvox/inspect/summary.h"

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include <algorithm>

using namespace vox;

namespace {

double signedVolume(const PolygonMesh& mesh) {
  double sum = 0;
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    const auto face = mesh.face(f);
    for (std::size_t i = 1; i + 1 < face.size(); ++i)
      sum += mesh.points[face[0]].dot(mesh.points[face[i]].cross(mesh.points[face[i + 1]]));
  }
  return sum / 6;
}

/// Longest side of the bounding box of a face.
double sizeOf(const PolygonMesh& mesh, Index f) {
  Box box;
  for (const Index v : mesh.face(f)) box.add(mesh.points[v]);
  return box.longestSide();
}

using Counts = std::map<std::uint64_t, std::uint64_t>;

}  // namespace

TEST_CASE("benchmark inputs are closed manifolds of one piece, wound outward", "[bench]") {
  for (const bench::Input& input : bench::inputs()) {
    CAPTURE(input.name);
    const PolygonMesh mesh = input.isLarge ? bench::scan(20) : input.make();
    const MeshSummary summary = summarize(mesh);
    CHECK(summary.defects.empty());
    CHECK(summary.boundaryLoops.empty());
    CHECK(summary.components == 1);
    CHECK(summary.eulerCharacteristic == (input.name == "torus" ? 0 : 2));
    CHECK(signedVolume(mesh) > 0);
  }
}

TEST_CASE("benchmark inputs have the faces and valences their names state", "[bench]") {
  const auto faces = [](const char* name) { return summarize(bench::makeInput(name)).faceSizes; };
  const auto valences = [](const char* name) { return summarize(bench::makeInput(name)).valences; };
  CHECK(faces("torus") == Counts{{4, 2048}});
  CHECK(valences("torus") == Counts{{4, 2048}});
  CHECK(faces("cube") == Counts{{4, 6}});
  CHECK(faces("triangles") == Counts{{3, 100352}});
  CHECK(faces("triangles_shuffled") == Counts{{3, 100352}});
  CHECK(valences("triangles") == valences("triangles_shuffled"));
  CHECK(faces("triangles_graded") == Counts{{3, 100352}});
  CHECK(summarize(bench::scan(20)).faceSizes == Counts{{3, 4 * 20 * 19}});
  CHECK(faces("cone") == Counts{{3, 2000}, {2000, 1}});
  CHECK(valences("cone") == Counts{{3, 2000}, {2000, 1}});
  CHECK(faces("prism") == Counts{{4, 5000}, {5000, 2}});
  CHECK(faces("sliver") == Counts{{4, 66}});
  CHECK(faces("graded") == Counts{{4, 120}, {6, 2}});
  CHECK(faces("quads") == Counts{{4, 6144}});
  CHECK(valences("quads") == Counts{{3, 2048}, {4, 3078}, {6, 1020}});
  CHECK_THROWS_AS(bench::makeInput("sphere"), UsageError);
}

TEST_CASE("faces of the graded mesh reach from 1 down to 1e-6", "[bench]") {
  const PolygonMesh mesh = bench::makeInput("graded");
  double least = 1e300;
  double most = 0;
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    least = std::min(least, sizeOf(mesh, f));
    most = std::max(most, sizeOf(mesh, f));
  }
  CHECK(least < 2e-6);
  CHECK(most >= 1);
}

TEST_CASE("shuffling changes the order of a mesh and not its box", "[bench]") {
  const PolygonMesh mesh = bench::makeInput("triangles");
  const PolygonMesh shuffled = bench::makeInput("triangles_shuffled");
  CHECK(usedBox(mesh).low == usedBox(shuffled).low);
  CHECK(usedBox(mesh).high == usedBox(shuffled).high);
  CHECK(mesh.points != shuffled.points);
  CHECK(bench::makeInput("triangles_shuffled").points == shuffled.points);
}
