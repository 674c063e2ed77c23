#include "libvox/volume/fill.h"

#include "libvox/core/parallel.h"
#include "libvox/grid/openvdb.h"
#include "libvox/volume/leaf_regions.h"
#include "libvox/volume/winding.h"
#include "tests/shapes.h"

#include <catch2/catch.hpp>

#include <random>
#include <vector>

using namespace vox;
using openvdb::Coord;
using openvdb::CoordBBox;
using openvdb::MaskTree;

namespace {

/// The voxels that no path of inactive voxels from the corner of a box reaches, by a flood voxel by
/// voxel.
MaskTree slowlyFilled(const MaskTree& surface) {
  CoordBBox box;
  surface.evalActiveVoxelBoundingBox(box);
  box.expand(1);
  MaskTree outside;
  std::vector<Coord> open = {box.min()};
  outside.setValueOn(box.min());
  while (!open.empty()) {
    const Coord at = open.back();
    open.pop_back();
    for (int side = 0; side < kSides; ++side) {
      Coord next = at;
      next[side / 2] += side % 2 == 0 ? -1 : 1;
      if (!box.isInside(next) || surface.isValueOn(next) || outside.isValueOn(next)) continue;
      outside.setValueOn(next);
      open.push_back(next);
    }
  }
  MaskTree solid;
  for (auto at = box.begin(); at != box.end(); ++at)
    if (!outside.isValueOn(*at)) solid.setValueOn(*at);
  return solid;
}

bool sameVoxels(const MaskTree& a, const MaskTree& b) {
  MaskTree voxelsA(a);
  MaskTree voxelsB(b);
  voxelsA.voxelizeActiveTiles();
  voxelsB.voxelizeActiveTiles();
  return a.activeVoxelCount() == b.activeVoxelCount() && voxelsA.hasSameTopology(voxelsB);
}

/// The voxels on the six sides of a box.
void addShell(MaskTree& tree, const CoordBBox& box) {
  for (int axis = 0; axis < 3; ++axis)
    for (const bool upper : {false, true}) {
      CoordBBox plate = box;
      (upper ? plate.min() : plate.max())[axis] = (upper ? box.max() : box.min())[axis];
      tree.denseFill(plate, true, true);
    }
  tree.voxelizeActiveTiles();
}

std::int64_t volumeOf(const CoordBBox& box) {
  return static_cast<std::int64_t>(box.volume());
}

}  // namespace

TEST_CASE("a fill has the voxels that a search from outside does not reach", "[volume][property]") {
  std::mt19937 random(7);
  for (const int side : {5, 20, 40})
    for (const double density : {0.3, 0.5, 0.65, 0.69, 0.72, 0.8}) {
      CAPTURE(side, density);
      MaskTree tree;
      const Coord origin(-13, 120, 4085);  // across leaves, lower and upper nodes
      std::bernoulli_distribution active(density);
      for (int i = 0; i < side; ++i)
        for (int j = 0; j < side; ++j)
          for (int k = 0; k < side; ++k)
            if (active(random)) tree.setValueOn(origin.offsetBy(i, j, k));
      const auto solid = filled(tree, {});
      CHECK(sameVoxels(*solid, slowlyFilled(tree)));
    }
}

TEST_CASE("a box is filled with tiles, and leaks through one missing voxel", "[volume]") {
  const CoordBBox box(Coord(-170, -20, 3900), Coord(170, 290, 4300));
  MaskTree tree;
  addShell(tree, box);
  const auto solid = filled(tree, {});
  CHECK(static_cast<std::int64_t>(solid->activeVoxelCount()) == volumeOf(box));
  CHECK(solid->activeTileCount() > 0);
  CHECK(solid->leafCount() == tree.leafCount());

  for (const Coord hole : {Coord(0, 0, 3900), Coord(-170, 5, 4099), Coord(33, 290, 4096)}) {
    MaskTree open(tree);
    open.setValueOff(hole);
    CHECK(filled(open, {})->activeVoxelCount() == open.activeVoxelCount());
  }
}

TEST_CASE("enclosed regions may be larger than the largest node", "[volume]") {
  // A shell of active tiles, 4096 thick, around 3 x 1 x 1 empty places of upper nodes. The middle
  // one has no upper node beside it.
  constexpr int kDim = 4096;
  MaskTree tree;
  for (int i = -1; i < 6; ++i)
    for (int j = -1; j < 2; ++j)
      for (int k = -1; k < 2; ++k) {
        if (i >= 0 && i < 5 && j == 0 && k == 0) continue;
        const Coord low(kDim * i, kDim * j, kDim * k);
        tree.sparseFill(CoordBBox(low, low.offsetBy(kDim - 1)), true, true);
        // One voxel is switched off, so that it is a node and not a tile of the root.
        tree.setValueOff(low.offsetBy(1000));
      }
  const std::int64_t wall = static_cast<std::int64_t>(tree.activeVoxelCount());
  const auto solid = filled(tree, {});
  const std::int64_t inside = std::int64_t{5} * kDim * kDim * kDim;
  const std::int64_t holes = 7 * 9 - 5;  // single inactive voxels, enclosed as well
  CHECK(static_cast<std::int64_t>(solid->activeVoxelCount()) == wall + inside + holes);

  tree.touchLeaf(Coord(kDim * 2 + 100, -1, 5));
  for (int y = -kDim; y < 0; ++y) tree.setValueOff(Coord(kDim * 2 + 100, y, 5));
  const std::int64_t channelled = static_cast<std::int64_t>(tree.activeVoxelCount());
  CHECK(static_cast<std::int64_t>(filled(tree, {})->activeVoxelCount()) == channelled + holes);
}

TEST_CASE("voxels scattered over all space enclose nothing", "[volume]") {
  std::mt19937 random(3);
  std::uniform_int_distribution<int> anywhere(-(1 << 30), 1 << 30);
  std::uniform_int_distribution<int> near(-20000, 20000);
  MaskTree tree;
  for (int i = 0; i < 300; ++i) {
    tree.setValueOn({anywhere(random), anywhere(random), anywhere(random)});
    tree.setValueOn({near(random), near(random), near(random)});
  }
  CHECK(filled(tree, {})->activeVoxelCount() == tree.activeVoxelCount());
}

TEST_CASE("cavities are chosen among all enclosed regions, each given by a voxel inside",
          "[volume]") {
  const CoordBBox outer(Coord(0), Coord(400));
  const CoordBBox middle(Coord(100), Coord(300));
  const CoordBBox inner(Coord(198), Coord(202));
  MaskTree tree;
  for (const CoordBBox& box : {outer, middle, inner}) addShell(tree, box);
  int regions = 0;
  const auto solid = filled(tree, [&](std::span<const Coord> voxels) {
    std::vector<bool> cavities;
    for (const Coord& voxel : voxels) {
      ++regions;
      cavities.push_back(middle.isInside(voxel) && !inner.isInside(voxel));
      CHECK_FALSE(tree.isValueOn(voxel));
    }
    return cavities;
  });
  CHECK(regions == 3);
  CHECK(solid->isValueOn({50, 50, 50}));
  CHECK_FALSE(solid->isValueOn({150, 150, 150}));
  CHECK(solid->isValueOn({200, 200, 200}));
  CoordBBox cavity = middle;
  cavity.expand(-1);
  CHECK(static_cast<std::int64_t>(solid->activeVoxelCount()) ==
        volumeOf(outer) - volumeOf(cavity) + volumeOf(inner));
}

TEST_CASE("thread count never changes a fill", "[volume][parallel]") {
  std::mt19937 random(11);
  MaskTree tree;
  std::uniform_int_distribution<int> at(0, 150);
  for (int i = 0; i < 2500000; ++i) tree.setValueOn({at(random), at(random), at(random)});
  const auto one = onThreads(1, [&] { return filled(tree, {}); });
  CHECK(one->activeVoxelCount() > tree.activeVoxelCount());
  for (const int threads : {2, 8}) {
    const auto more = onThreads(threads, [&] { return filled(tree, {}); });
    CHECK(more->hasSameTopology(*one));
  }
}

TEST_CASE("the inactive regions of a leaf are its sets connected through faces", "[volume]") {
  LeafWords checkered{};
  for (int i = 0; i < 512; ++i)
    if ((i ^ i >> 3 ^ i >> 6) & 1)
      checkered[static_cast<std::size_t>(i / 64)] |= std::uint64_t{1} << (i % 64);
  std::vector<LeafWords> regions;
  appendInactiveRegions(checkered, regions);
  CHECK(regions.size() == 256);
  regions.clear();
  appendInactiveRegions(LeafWords{}, regions);
  REQUIRE(regions.size() == 1);
  for (int side = 0; side < kSides; ++side) CHECK(sideOf(regions[0], side) == ~std::uint64_t{0});
}

TEST_CASE("a side of a leaf has the voxels of that side", "[volume]") {
  std::mt19937_64 random(5);
  LeafWords leaf{};
  for (auto& word : leaf) word = random();
  const auto isOn = [&](int x, int y, int z) {
    return (leaf[static_cast<std::size_t>(x)] >> (8 * y + z) & 1) != 0;
  };
  for (int side = 0; side < kSides; ++side)
    for (int a = 0; a < 8; ++a)
      for (int b = 0; b < 8; ++b) {
        const int end = side % 2 == 0 ? 0 : 7;
        const bool on = side < 2 ? isOn(end, a, b) : side < 4 ? isOn(a, end, b) : isOn(a, b, end);
        CHECK((sideOf(leaf, side) >> (8 * a + b) & 1) == on);
      }
}

TEST_CASE("the deepest voxel of a region is the centre of the largest box in it", "[volume]") {
  LeafWords region{};
  region[0] = 0xFF;  // a rod
  for (std::size_t x = 2; x < 7; ++x) region[x] |= 0x0000001F1F1F1F1FU << 8U;
  region[7] = 0;
  const DeepVoxel deep = deepestOf(region);
  CHECK(deep.depth >= 1);
  CHECK((deep.voxel >> 6) == 4);
}

TEST_CASE("winding numbers count the closed surfaces around a voxel", "[volume]") {
  PolygonMesh shells = test::cube();
  for (Vec3d& p : shells.points) p *= 20;
  shells = test::together(shells, test::insideOut(test::cube()), Vec3d(0, 0, 0), 10);
  shells = test::together(shells, test::cube(), Vec3d(0, 0, 0), 5);
  const std::vector<Coord> voxels = {{0, 0, 0},    {7, 0, 0}, {0, -15, 3},  {0, 0, 21}, {-3, 4, 2},
                                     {19, 19, 19}, {9, 9, 9}, {-6, -6, -6}, {15, 0, 0}, {0, 0, 0}};
  const std::vector<int> expected = {1, 0, 1, 0, 1, 1, 0, 0, 1, 1};
  CHECK(windingNumbers(shells, voxels) == expected);
  CHECK(onThreads(8, [&] { return windingNumbers(shells, voxels); }) == expected);
  CHECK(windingNumbers(shells, {}).empty());
}
