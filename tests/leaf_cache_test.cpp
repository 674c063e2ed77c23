#include "libvox/grid/leaf_cache.h"

#include <catch2/catch.hpp>

#include <random>

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

    SurfaceGrid grid;
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
