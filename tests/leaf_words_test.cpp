#include "libvox/grid/leaf_words.h"

#include "libvox/grid/openvdb.h"

#include <catch2/catch.hpp>

#include <random>

using namespace vox;

TEST_CASE("number and box of the voxels of a leaf are those that OpenVDB finds", "[grid]") {
  std::mt19937_64 random(1);
  using Leaf = openvdb::MaskTree::LeafNodeType;
  for (int i = 0; i < 2000; ++i) {
    Leaf leaf(openvdb::Coord(-8, 16, 0), i == 0);  // the first one is full
    const auto voxels = i == 0 ? 0 : 1 + random() % (i % 2 == 0 ? 4 : 400);
    for (std::uint64_t v = 0; v < voxels; ++v)
      leaf.setValueOn(static_cast<openvdb::Index>(random() % Leaf::SIZE));
    CHECK(countOf(activeWords(leaf)) == leaf.onVoxelCount());
    openvdb::CoordBBox expected;
    leaf.evalActiveBoundingBox(expected);
    const LeafBox box = boxOf(activeWords(leaf));
    CHECK(openvdb::Coord(box.low.data()) + leaf.origin() == expected.min());
    CHECK(openvdb::Coord(box.high.data()) + leaf.origin() == expected.max());
  }
  CHECK(countOf(LeafWords{}) == 0);
}
