#include "libvox/grid/leaf_cache.h"

#include "libvox/grid/voxel.h"

#include <catch2/catch.hpp>
#include <hwy/targets.h>

#include <random>
#include <vector>

using namespace vox;
using openvdb::Coord;

TEST_CASE("a block has the voxels of its bits, wherever it lies", "[grid][property]") {
  std::mt19937_64 random(1);
  std::uniform_int_distribution<std::int32_t> place(-20, 20);
  for (int i = 0; i < 3000; ++i) {
    const Coord origin(place(random), place(random), place(random));
    // Full, empty, single and random blocks.
    std::uint64_t voxels = random();
    if (i % 4 == 1) voxels = std::uint64_t{1} << (voxels & 63U);
    if (i % 4 == 2) voxels = i % 8 == 2 ? 0 : ~std::uint64_t{0};
    CAPTURE(origin, voxels);

    ActiveVoxels grid;
    LeafCache cache(grid);
    cache.addBlock(origin, voxels);
    cache.flush();

    openvdb::MaskTree expected;
    for (std::int32_t bit = 0; bit < 64; ++bit)
      if ((voxels >> bit & 1U) != 0)
        expected.setValueOn(origin + Coord(bit >> 4, bit >> 2 & 3, bit & 3));
    REQUIRE(grid.takeTree()->hasSameTopology(expected));
  }
}

TEST_CASE("positions go to the voxels nearest to them, on every instruction set", "[grid][simd]") {
  std::mt19937_64 random(2);
  std::uniform_int_distribution<int> quarters(-400, 400);  // many of them ties
  std::vector<Vec3d> positions;
  for (int i = 0; i < 300; ++i)
    positions.push_back(Vec3d(quarters(random), quarters(random), quarters(random)) / 4.0);
  positions.emplace_back(0.49999999999999994, -0.5, 2147483000.0);
  positions.emplace_back(-2147483000.5, 7.5, -8.5);
  for (const std::int64_t target : hwy::SupportedAndGeneratedTargets()) {
    CAPTURE(hwy::TargetName(target));
    hwy::GetChosenTarget().Update(target);
    for (const std::size_t count : {0U, 1U, 7U, 8U, 9U, 71U, 302U}) {
      CAPTURE(count);
      const std::span some = std::span(positions).last(count);
      ActiveVoxels grid;
      LeafCache cache(grid);
      cache.add(some);
      cache.flush();
      openvdb::MaskTree expected;
      for (const Vec3d& position : some) expected.setValueOn(voxelOf(position));
      CHECK(grid.takeTree()->hasSameTopology(expected));
    }
  }
  hwy::GetChosenTarget().DeInit();
}
