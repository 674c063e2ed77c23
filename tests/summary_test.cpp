#include "libvox/inspect/summary.h"

#include "libvox/core/error.h"
#include "libvox/pipeline/convert.h"
#include "tests/shapes.h"
#include "tests/temporary_folder.h"

#include <catch2/catch.hpp>

using namespace vox;
using Catch::Contains;
using Histogram = std::map<std::uint64_t, std::uint64_t>;

TEST_CASE("a summary counts all elements", "[inspect][golden]") {
  const MeshSummary prism = summarize(test::prism(5));
  CHECK(prism.points == 10);
  CHECK(prism.edges == 15);
  CHECK(prism.faces == 7);
  CHECK(prism.components == 1);
  CHECK(prism.eulerCharacteristic == 2);
  CHECK(prism.boundaryLoops.empty());
  CHECK(prism.faceSizes == Histogram{{4, 5}, {5, 2}});
  CHECK(prism.valences == Histogram{{3, 10}});

  const MeshSummary sheet = summarize(test::sheet(5, 4));
  CHECK(sheet.eulerCharacteristic == 1);
  CHECK(sheet.boundaryLoops == std::vector<std::uint64_t>{18});

  CHECK(summarize(test::torusGrid(8, 5)).eulerCharacteristic == 0);
  CHECK(summarize(test::moebius(8)).eulerCharacteristic == 0);
  CHECK(summarize(test::bowTie()).components == 2);
}

TEST_CASE("genus, closedness and orientability do not depend on winding", "[inspect][golden]") {
  const auto check = [](const PolygonMesh& mesh, bool closed, bool orientable, int genus) {
    for (const double flips : {0.0, 0.5, 1.0}) {
      CAPTURE(flips);
      const MeshSummary summary = summarize(test::stirred(mesh, flips, 3));
      CHECK(summary.closed == closed);
      CHECK(summary.orientable == orientable);
      CHECK(summary.genus.value_or(-1) == genus);
    }
  };
  constexpr int kNone = -1;
  check(test::prism(5), true, true, 0);
  check(test::torusGrid(8, 5), true, true, 1);
  check(test::together(test::torusGrid(8, 5), test::torusGrid(5, 5), {9, 0, 0}), true, true, 2);
  check(test::together(test::cube(), test::cube(), {9, 0, 0}), true, true, 0);
  check(test::sheet(3, 3), false, true, kNone);
  check(test::moebius(8), false, false, kNone);
  check(test::klein(8, 5), true, false, kNone);
  check(test::bowTie(), true, true, kNone);
  check(test::book(3), false, true, kNone);
}

TEST_CASE("boundaries are those of edges of one face, whatever the winding", "[inspect]") {
  CHECK(summarize(test::stirred(test::sheet(5, 4), 0.5, 1)).boundaryLoops ==
        std::vector<std::uint64_t>{18});
  CHECK(summarize(test::moebius(8)).boundaryLoops == std::vector<std::uint64_t>{16});
  CHECK(summarize(test::stirred(test::torusGrid(8, 5), 0.5, 1)).boundaryLoops.empty());
  CHECK(summarize(test::tube(7, 3)).boundaryLoops == std::vector<std::uint64_t>{7, 7});
}

TEST_CASE("defects and unused points are counted apart", "[inspect]") {
  PolygonMesh mesh = test::cube();
  mesh.points.emplace_back(100, 0, 0);
  const MeshSummary summary = summarize(mesh);
  CHECK(summary.points == 9);
  CHECK(summary.eulerCharacteristic == 2);
  CHECK(summary.box.high == Vec3d(1, 1, 1));
  CHECK(summary.defects.size() == 1);
}

TEST_CASE("a .vdb file is summarized grid by grid", "[inspect]") {
  const test::TemporaryFolder folder;
  Scene scene;
  scene.objects.push_back({"cube", test::cube()});
  ConvertOptions options;
  options.dim = 20;
  options.grids = std::vector{GridKind::kDensity, GridKind::kMask};
  const Conversion conversion = convert(scene, options);
  writeGrids(folder / "cube.vdb", conversion, false);

  const auto grids = summarizeVdb(folder / "cube.vdb");
  REQUIRE(grids.size() == 2);
  CHECK(grids[0].name == "density");
  CHECK(grids[0].type == "Tree_float_5_4_3");
  CHECK(grids[0].gridClass == "fog volume");
  CHECK(grids[1].type == "Tree_mask_5_4_3");
  for (const GridSummary& grid : grids) {
    CHECK(grid.activeVoxels == conversion.report.activeVoxels);
    CHECK(grid.voxelSize == std::array<double, 3>{0.1, 0.1, 0.1});
    CHECK(grid.metadata.at("vox_guarantee") == "6-separating");
    CHECK(grid.metadata.at("vox_options") == "dim=20");
    // Face centres of the cube stay on the surface: x = +-1 is index +-10.
    CHECK(grid.low == std::array<int, 3>{-10, -10, -10});
    CHECK(grid.high == std::array<int, 3>{10, 10, 10});
  }
}

TEST_CASE("files that are not OpenVDB are refused", "[inspect][error]") {
  const test::TemporaryFolder folder;
  CHECK_THROWS_WITH(summarizeVdb(folder / "none.vdb"), Contains("none.vdb: no such file"));
  CHECK_THROWS_WITH(summarizeVdb(folder.path()), Contains("is a directory"));
  CHECK_THROWS_AS(summarizeVdb(folder.write("empty.vdb", "")), InputError);
  CHECK_THROWS_AS(summarizeVdb(folder.write("text.vdb", "not a grid, not at all")), InputError);
}

TEST_CASE("a damaged file of libvox is recognised by its hash", "[inspect][error]") {
  const test::TemporaryFolder folder;
  Scene scene;
  scene.objects.push_back({"cube", test::cube()});
  ConvertOptions options;
  options.dim = 20;
  writeGrids(folder / "cube.vdb", convert(scene, options), false);
  const std::string good = test::contentOf(folder / "cube.vdb");
  REQUIRE_NOTHROW(summarizeVdb(folder / "cube.vdb"));
  for (std::size_t at = 60; at < good.size(); at += good.size() / 40) {
    CAPTURE(at);
    std::string flipped = good;
    flipped[at] = static_cast<char>(flipped[at] ^ 4);
    CHECK_THROWS_AS(summarizeVdb(folder.write("flipped.vdb", flipped)), InputError);
    CHECK_THROWS_AS(summarizeVdb(folder.write("cut.vdb", good.substr(0, at))), InputError);
  }
}
