#include "libvox/inspect/components.h"

#include "libvox/core/parallel.h"
#include "libvox/grid/openvdb.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cstdlib>
#include <random>
#include <set>

using namespace vox;
using openvdb::Coord;
using openvdb::CoordBBox;
using openvdb::MaskTree;

namespace {

bool sameComponents(const std::vector<Component>& a, const std::vector<Component>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& x, const auto& y) {
    return x.voxels == y.voxels && x.first == y.first;
  });
}

/// The components in a box, by a flood voxel by voxel. Inactive components that reach the rim of
/// the box are left out.
std::vector<Component> floodedComponents(const MaskTree& tree, bool active) {
  const CoordBBox box = CoordBBox::createCube(Coord(-30), 60);
  std::set<Coord> left;
  for (const Coord& at : box)
    if (tree.isValueOn(at) == active) left.insert(at);
  std::vector<Component> all;
  while (!left.empty()) {
    std::vector<Coord> component = {*left.begin()};
    left.erase(left.begin());
    bool rim = false;
    for (std::size_t i = 0; i < component.size(); ++i) {
      const Coord at = component[i];
      for (int axis = 0; axis < 3; ++axis)
        rim = rim || at[axis] == box.min()[axis] || at[axis] == box.max()[axis];
      for (int step = 0; step < 27; ++step) {
        const Coord d(step / 9 - 1, step / 3 % 3 - 1, step % 3 - 1);
        if (!active && std::abs(d.x()) + std::abs(d.y()) + std::abs(d.z()) != 1) continue;
        if (left.erase(at + d) > 0) component.push_back(at + d);
      }
    }
    const Coord first = *std::min_element(component.begin(), component.end());
    if (active || !rim) all.push_back({component.size(), {first.x(), first.y(), first.z()}});
  }
  return all;
}

MaskTree shell(int radius) {
  MaskTree tree;
  for (const Coord& at : CoordBBox::createCube(Coord(-radius - 1), 2 * radius + 3)) {
    const double r = at.asVec3d().length();
    if (r >= radius - 1.1 && r <= radius) tree.setValueOn(at);
  }
  return tree;
}

}  // namespace

TEST_CASE("components are those that a flood finds", "[inspect][components][property]") {
  std::mt19937 random(1);
  std::uniform_int_distribution<int> at(-20, 19);
  std::uniform_int_distribution<int> block(-2, 1);
  for (int i = 0; i < 24; ++i) {
    CAPTURE(i);
    MaskTree tree;
    const int count = i % 4 == 3 ? 20000 : 1500 * (i % 4 + 1);
    for (int k = 0; k < count; ++k) tree.setValueOn({at(random), at(random), at(random)});
    if (i % 3 == 0)
      for (int k = 0; k < 5; ++k)
        tree.fill(
            CoordBBox::createCube({8 * block(random), 8 * block(random), 8 * block(random)}, 8),
            true, k < 4);
    CHECK(sameComponents(activeComponents(tree), floodedComponents(tree, true)));
    CHECK(sameComponents(Cavities(tree).enclosed(), floodedComponents(tree, false)));
    const auto one = onThreads(1, [&] { return activeComponents(tree); });
    CHECK(sameComponents(one, onThreads(8, [&] { return activeComponents(tree); })));
  }
}

TEST_CASE("cavities are found however far their walls are apart", "[inspect][components]") {
  // A box of tiles and leaves, with a gap of many leaves inside and a second box in it.
  MaskTree tree;
  const auto box = [&](int reach) {
    for (int axis = 0; axis < 3; ++axis)
      for (const int side : {-reach, reach}) {
        CoordBBox wall(Coord(-reach), Coord(reach));
        wall.min()[axis] = wall.max()[axis] = side;
        tree.fill(wall, true, true);
      }
  };
  box(200);
  box(60);
  const auto cube = [](std::uint64_t side) { return side * side * side; };
  const auto enclosed = Cavities(tree).enclosed();
  REQUIRE(enclosed.size() == 2);
  CHECK(enclosed[0].voxels == cube(399) - cube(121));
  CHECK(enclosed[0].first == VoxelIndex{-199, -199, -199});
  CHECK(enclosed[1].voxels == cube(119));
  CHECK(activeComponents(tree).size() == 2);
  tree.setValueOff({200, 3, 3});
  CHECK(Cavities(tree).enclosed().size() == 1);
  CHECK(Cavities(tree).isOutside({-100, 100, 7}));
  CHECK_FALSE(Cavities(tree).isOutside({10, 10, 7}));
}

TEST_CASE("solid tiles are components and have no cavities", "[inspect][components]") {
  MaskTree tree;
  tree.fill(CoordBBox::createCube({0, 0, 0}, 4096), true, true);
  tree.fill(CoordBBox::createCube({-128, -128, -128}, 128), true, true);  // through a corner
  const auto components = activeComponents(tree);
  REQUIRE(components.size() == 1);
  CHECK(components[0].voxels == (std::uint64_t{1} << 36U) + (1 << 21));
  CHECK(Cavities(tree).enclosed().empty());
  tree.fill(CoordBBox(Coord(1000, 2000, 3000), Coord(1000, 2000, 3006)), false, false);
  REQUIRE(Cavities(tree).enclosed().size() == 1);
  CHECK(Cavities(tree).enclosed()[0].voxels == 7);
}

TEST_CASE("a leak in a shell is found wherever it is", "[inspect][components]") {
  const MaskTree whole = shell(12);
  REQUIRE(Cavities(whole).enclosed().size() == 1);
  CHECK(leakingSpaces(whole, 100).empty());
  std::size_t leaks = 0;
  for (auto voxel = whole.cbeginValueOn(); voxel; ++voxel) {
    MaskTree holed(whole);
    holed.setValueOff(voxel.getCoord());
    const bool leaky = floodedComponents(holed, false).empty();
    leaks += leaky;
    REQUIRE(leakingSpaces(holed, 100).size() == (leaky ? 1 : 0));
    if (leaks == 25) break;
  }
  CHECK(leaks == 25);
}
