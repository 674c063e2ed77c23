// Runs in parts: pages, cuts, and grids that are those of the whole run, page by page.

#include "libvox/options/run_part.h"

#include "libvox/core/error.h"
#include "libvox/grid/crop.h"
#include "libvox/grid/openvdb.h"
#include "libvox/grid/pages.h"
#include "libvox/grid/region.h"
#include "libvox/io/merge_vdb.h"
#include "libvox/pipeline/convert.h"
#include "libvox/pipeline/cut.h"
#include "tests/conversion.h"
#include "tests/scenes.h"
#include "tests/shapes.h"
#include "tests/temporary_folder.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <filesystem>
#include <map>
#include <random>
#include <sstream>
#include <string>
#include <vector>

using namespace vox;
using namespace vox::test;
using openvdb::Coord;
using openvdb::CoordBBox;

namespace {

const std::vector<GridKind> kAllKinds = {GridKind::kMask,   GridKind::kDensity, GridKind::kSurface,
                                         GridKind::kNormal, GridKind::kColor,   GridKind::kPart};

Coord randomCoord(std::mt19937& random, int most) {
  std::uniform_int_distribution<int> number(-most, most);
  return {number(random), number(random), number(random)};
}

Conversion partOf(const Scene& scene, ConvertOptions options, int number, int count) {
  options.part = RunPart{number, count};
  return convert(scene, resolve(scene, options));
}

template <class Node>
bool areSame(const Node& a, const Node& b) {
  if (a.getChildMask() != b.getChildMask() || a.getValueMask() != b.getValueMask()) return false;
  for (openvdb::Index i = 0; i < Node::NUM_VALUES; ++i) {
    const auto& ofA = a.getTable()[i];
    const auto& ofB = b.getTable()[i];
    const bool same =
        a.isChildMaskOn(i) ? *ofA.getChild() == *ofB.getChild() : ofA.getValue() == ofB.getValue();
    if (!same) return false;
  }
  return true;
}

/// What a page of a tree is: a lower node, or a tile.
template <class TreeT>
struct Pages {
  using Upper = typename TreeT::RootNodeType::ChildNodeType;
  using Lower = typename Upper::ChildNodeType;
  std::map<Coord, const Lower*> nodes;
  std::map<Coord, std::pair<typename TreeT::ValueType, bool>> tiles;  // but background

  void add(const TreeT& tree) {
    std::vector<const Upper*> uppers;
    tree.getNodes(uppers);
    for (const Upper* upper : uppers)
      for (openvdb::Index i = 0; i < Upper::NUM_VALUES; ++i) {
        const Coord at = upper->offsetToGlobalCoord(i);
        if (upper->isChildMaskOn(i)) {
          CHECK(nodes.emplace(at, upper->getTable()[i].getChild()).second);
          continue;
        }
        const auto value = upper->getTable()[i].getValue();
        if (value != tree.background() || upper->isValueMaskOn(i))
          CHECK(tiles.emplace(at, std::pair(value, upper->isValueMaskOn(i))).second);
      }
  }
};

/// Checks that some trees together have the pages of another one, each once.
template <class GridT>
void checkTogether(const openvdb::GridBase& whole, const std::vector<Conversion>& parts,
                   std::size_t grid) {
  if (!whole.isType<GridT>()) return;
  Pages<typename GridT::TreeType> expected, found;
  expected.add(static_cast<const GridT&>(whole).tree());
  for (const Conversion& part : parts)
    found.add(static_cast<const GridT&>(*part.grids[grid]).tree());
  CHECK(found.tiles == expected.tiles);
  CHECK(found.nodes.size() == expected.nodes.size());
  std::size_t same = 0;
  for (const auto& [at, node] : expected.nodes)
    same += found.nodes.count(at) == 1 && areSame(*node, *found.nodes[at]) ? 1 : 0;
  CHECK(same == expected.nodes.size());
}

/// Checks parts of a conversion against the whole of it.
void checkParts(const Scene& scene, const ConvertOptions& options, int count) {
  CAPTURE(count);
  const Conversion whole = convert(scene, resolve(scene, options));
  std::vector<Conversion> parts;
  for (int number = 1; number <= count; ++number)
    parts.push_back(partOf(scene, options, number, count));
  for (std::size_t grid = 0; grid < whole.grids.size(); ++grid) {
    CAPTURE(whole.grids[grid]->getName());
    for (const Conversion& part : parts) {
      REQUIRE(part.grids.size() == whole.grids.size());
      CHECK(part.grids[grid]->getName() == whole.grids[grid]->getName());
      CHECK(part.grids[grid]->getGridClass() == whole.grids[grid]->getGridClass());
      CHECK(part.grids[grid]->transform() == whole.grids[grid]->transform());
    }
    checkTogether<openvdb::MaskGrid>(*whole.grids[grid], parts, grid);
    checkTogether<openvdb::FloatGrid>(*whole.grids[grid], parts, grid);
    checkTogether<openvdb::Vec3SGrid>(*whole.grids[grid], parts, grid);
    checkTogether<openvdb::Int32Grid>(*whole.grids[grid], parts, grid);
  }
}

std::vector<Coord> pagesOf(const CoordBBox& voxels) {
  std::vector<Coord> pages;
  for (auto at = CoordBBox(voxels.min() >> kPageLog2, voxels.max() >> kPageLog2).begin(); at; ++at)
    pages.push_back(*at);
  return pages;
}

}  // namespace

TEST_CASE("pages come in the order in which OpenVDB writes lower nodes", "[run-part][property]") {
  std::mt19937 random(3);
  openvdb::MaskTree tree;
  for (int i = 0; i < 2000; ++i) tree.setValueOn(randomCoord(random, 20000));
  using Lower = openvdb::MaskTree::RootNodeType::ChildNodeType::ChildNodeType;
  std::vector<const Lower*> nodes;
  std::as_const(tree).getNodes(nodes);  // depth first, as in the file
  REQUIRE(nodes.size() > 1000);
  for (std::size_t i = 1; i < nodes.size(); ++i) {
    const Coord a = nodes[i - 1]->origin() >> kPageLog2;
    const Coord b = nodes[i]->origin() >> kPageLog2;
    CHECK(isBefore(a, b));
    CHECK_FALSE(isBefore(b, a));
  }
  CHECK_FALSE(isBefore({1, 2, 3}, {1, 2, 3}));
}

TEST_CASE("regions of pages hold what brute force finds", "[run-part][property]") {
  std::mt19937 random(4);
  for (int round = 0; round < 200; ++round) {
    PageRange range{randomCoord(random, 40), randomCoord(random, 40)};
    if (isBefore(*range.end, *range.begin)) std::swap(range.begin, range.end);
    if (round % 5 == 0) range.begin.reset();
    if (round % 7 == 0) range.end.reset();
    const Region region(range);
    const Coord low = randomCoord(random, 5000);
    const CoordBBox box(low, low.offsetBy(static_cast<int>(random() % 700)));
    const std::vector<Coord> pages = pagesOf(box);
    const bool meets =
        std::any_of(pages.begin(), pages.end(), [&](const Coord& b) { return range.contains(b); });
    CHECK(region.meetsPages(box) == meets);
    CHECK(region.contains(low) == range.contains(low >> kPageLog2));
    constexpr int kMargin = 9;
    CoordBBox grown = box;
    grown.expand(kMargin);
    CHECK(region.grown(kMargin).meetsPages(box) == region.meetsPages(grown));
  }
}

TEST_CASE("cropping to pages keeps their nodes and cuts large tiles", "[run-part]") {
  openvdb::FloatTree tree(3.0F);
  tree.fill(CoordBBox(Coord(-4096), Coord(4095)), -1.0F, true);  // tiles of the root
  tree.setValueOn({100, 100, 100}, 7.0F);
  tree.setValueOn({5000, 0, 0}, 8.0F);
  const PageRange range{Coord(0, 0, 0), Coord(0, 1, 0)};  // 32 pages along z
  openvdb::FloatTree part(tree);
  crop(part, Region(range));
  CHECK(part.activeVoxelCount() == 32ULL * 128 * 128 * 128);
  CHECK(part.getValue({100, 100, 100}) == 7.0F);
  CHECK(part.getValue({127, 127, 4095}) == -1.0F);
  CHECK(part.getValue({0, 128, 0}) == 3.0F);
  CHECK(part.getValue({5000, 0, 0}) == 3.0F);
  CHECK_FALSE(part.isValueOn({-1, 0, 0}));
}

TEST_CASE("pages are cut into ranges of about equal cost", "[run-part][property]") {
  std::mt19937 random(5);
  for (const int count : {1, 2, 3, 7, 64, 1000}) {
    std::map<Coord, std::uint64_t, bool (*)(const Coord&, const Coord&)> costs(isBefore);
    for (int i = 0; i < 300; ++i) costs[randomCoord(random, 60)] = 1 + random() % 1000;
    PageCosts all;
    double sum = 0, heaviest = 0;
    for (const auto& [page, cost] : costs) {
      all.pages.push_back(page);
      all.costs.push_back(cost);
      sum += static_cast<double>(cost);
      heaviest = std::max(heaviest, static_cast<double>(cost));
    }
    const std::vector<PageShare> shares = cutInto(count, all);
    REQUIRE(shares.size() == static_cast<std::size_t>(count));
    double together = 0;
    for (const PageShare& share : shares) {
      CHECK(share.cost <= 1.0 / count + heaviest / sum + 1e-12);
      together += share.cost;
    }
    CHECK(together == Approx(1));
    for (int i = 0; i < 500; ++i) {  // also pages without a cost are in one range
      const Coord page = randomCoord(random, 100);
      CHECK(std::count_if(shares.begin(), shares.end(),
                          [&](const PageShare& share) { return share.range.contains(page); }) == 1);
    }
  }
}

TEST_CASE("parts have the grids of the whole run, page by page", "[run-part][pipeline]") {
  ConvertOptions options;
  options.grids = kAllKinds;
  options.dim = 300;
  SECTION("surface") {
    checkParts(oneObject(torusGrid(8, 5)), options, 3);
  }
  SECTION("solid, more parts than pages") {
    options.volume.fill = Fill::kSolid;
    checkParts(oneObject(cube()), options, 64);
  }
  SECTION("soft") {
    options.grids = {GridKind::kDensity, GridKind::kNormal, GridKind::kColor};
    options.volume.edge = Edge::kSoft;
    checkParts(oneObject(torusGrid(8, 5)), options, 2);
  }
  SECTION("open") {
    checkParts(oneObject(sheet(5, 4)), options, 3);
  }
  SECTION("several objects that meet, solid") {
    options.volume.fill = Fill::kSolid;
    checkParts(sceneOf({cube(), moved(torusGrid(8, 5), {0.5, 0.5, 0.7})}), options, 4);
  }
  SECTION("polygons, with a box") {
    options.grids = {GridKind::kMask, GridKind::kSurface, GridKind::kNormal};
    options.until = StopRule{.levels = 2};
    options.bounds = {-0.8, -0.8, -0.3, 0.9, 0.5, 0.8};
    checkParts(oneObject(cube()), options, 3);
  }
}

TEST_CASE("merged parts have the bytes of the whole run, also if some are made in halves",
          "[run-part][merge]") {
  ConvertOptions options;
  options.grids = kAllKinds;
  options.dim = 400;
  options.volume.fill = GENERATE(Fill::kSurface, Fill::kSolid);
  const Scene scene = oneObject(torusGrid(8, 5));
  const TemporaryFolder folder;
  const auto write = [&](int number, int count) {
    return folder.write(std::to_string(number) + "_" + std::to_string(count) + ".vdb",
                        bytesOf(partOf(scene, options, number, count)));
  };
  const std::string whole = bytesOf(convert(scene, resolve(scene, options)));
  const auto merged = [](const std::vector<std::filesystem::path>& files) {
    std::stringstream stream(std::ios::in | std::ios::out | std::ios::binary);
    mergeVdb(stream, files);
    return stream.str();
  };
  CHECK((merged({write(3, 3), write(1, 3), write(2, 3)}) == whole));
  CHECK((merged({write(1, 4), write(5, 16), write(6, 16), write(4, 8), write(2, 2)}) == whole));
  CHECK_THROWS_WITH(
      merged({write(1, 4), write(2, 3)}),
      Catch::EndsWith("1_4.vdb: is part 1 of 4, which does not fit to parts of 3") ||
          Catch::EndsWith("2_3.vdb: is part 2 of 3, which does not fit to parts of 4"));
  CHECK_THROWS_WITH(merged({write(1, 4), write(5, 16), write(2, 2)}),
                    Catch::Contains("is one of 16 parts, of which parts 6-8 are missing"));
}

TEST_CASE("large level sets are made page by page", "[run-part][level-set][pipeline]") {
  ConvertOptions options;
  options.grids = {GridKind::kSurface};
  options.dim = 1100;
  SECTION("with inner pages") {
    checkParts(oneObject(cube()), options, 5);
  }
  SECTION("a sheet") {
    options.dim = 1900;
    checkParts(oneObject(sheet(5, 4)), options, 3);
  }
}

TEST_CASE("a part of a large surface that meets itself is refused", "[run-part][error]") {
  // One side of a torus is pulled through the other one.
  PolygonMesh mesh = torusGrid(8, 5);
  for (Vec3d& p : mesh.points)
    if (p.x() > 0.5) p.x() = 1 - 2.5 * p.x();
  ConvertOptions options;
  options.grids = {GridKind::kSurface};
  options.dim = 2000;
  const Scene scene = oneObject(mesh);
  bool isRefused = false;
  for (int number = 1; number <= 3; ++number) try {
      partOf(scene, options, number, 3);
    } catch (const MeshError& error) {
      isRefused = true;
      CHECK(std::string(error.what()).find("meets itself near the voxel (") != std::string::npos);
    }
  CHECK(isRefused);
}

TEST_CASE("parts have the same bytes for any number of threads", "[run-part][parallel]") {
  ConvertOptions options;
  options.grids = kAllKinds;
  options.dim = 300;
  const Scene scene = oneObject(torusGrid(8, 5));
  options.run.threads = 1;
  const std::string one = bytesOf(partOf(scene, options, 2, 3));
  for (const int threads : {2, 8}) {
    options.run.threads = threads;
    CHECK(bytesOf(partOf(scene, options, 2, 3)) == one);
  }
}

TEST_CASE("parts agree whether 16 bits are enough, also those without voxels", "[run-part]") {
  ConvertOptions options;
  options.grids = {GridKind::kDensity, GridKind::kSurface};
  options.dim = 60;
  options.volume.half = true;
  options.volume.gain = GENERATE(1.0, 1e5);
  const Scene scene = oneObject(scaled(cube(), GENERATE(1.0, 1e7)));
  const Conversion whole = convert(scene, resolve(scene, options));
  for (int number = 1; number <= 12; ++number) {
    const Conversion part = partOf(scene, options, number, 12);
    for (std::size_t i = 0; i < 2; ++i)
      CHECK(part.grids[i]->saveFloatAsHalf() == whole.grids[i]->saveFloatAsHalf());
  }
}

TEST_CASE("files of parts say which they are", "[run-part]") {
  ConvertOptions options;
  options.dim = 40;
  const Conversion part = partOf(oneObject(cube()), options, 2, 3);
  CHECK(part.grids[0]->metaValue<openvdb::Int32>(kRunPartMetadata) == 2);
  CHECK(part.grids[0]->metaValue<openvdb::Int32>(kRunPartsMetadata) == 3);
  CHECK(part.grids[0]->metaValue<std::string>("vox_options") == "dim=40");
}

TEST_CASE("parts fit into memory that the whole does not fit into", "[run-part][estimate]") {
  const GridKind kind = GENERATE(GridKind::kMask, GridKind::kDensity, GridKind::kSurface);
  CAPTURE(nameIn(kGridNames, kind));
  ConvertOptions options;
  options.grids = {kind};
  options.dim = 4000;
  const Scene scene = oneObject(torusGrid(8, 5));
  std::vector<std::string> warnings;
  const Estimate whole = estimate(scene, resolve(scene, options), warnings);
  options.run.maxMemory = static_cast<std::uint64_t>(whole.bytes / 4);
  CHECK(estimate(scene, resolve(scene, options), warnings).refusal.find(" parts (--part 1/") !=
        std::string::npos);
  double together = 0;
  for (int number = 1; number <= 16; ++number) {
    options.part = RunPart{number, 16};
    const Estimate part = estimate(scene, resolve(scene, options), warnings);
    CHECK(part.refusal.empty());
    CHECK(part.shares.size() == 16);
    together += part.grids[0].voxels;
  }
  CHECK(together == Approx(whole.grids[0].voxels).epsilon(0.01));
}

TEST_CASE("impossible parts are refused", "[run-part][error]") {
  const Scene scene = oneObject(cube());
  for (const RunPart part : {RunPart{0, 3}, RunPart{4, 3}, RunPart{1, 0}, RunPart{-1, -1},
                             RunPart{1, kMostRunParts + 1}}) {
    ConvertOptions options;
    options.part = part;
    CHECK_THROWS_AS(resolve(scene, options), UsageError);
  }
  ConvertOptions options;
  options.part = RunPart{1, 2};
  options.split = Split::kPart;
  CHECK_THROWS_AS(resolve(scene, options), UsageError);
}
