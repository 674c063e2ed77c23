// The sides of bricks without leaves.

#include "libvox/pipeline/brick_signs.h"

#include "libvox/grid/bricks.h"
#include "libvox/grid/openvdb.h"

#include <cstddef>
#include <unordered_map>

namespace vox {
namespace {

using openvdb::Coord;
using Lower = openvdb::FloatTree::RootNodeType::ChildNodeType::ChildNodeType;
static_assert(Lower::DIM == kBrickSide);

/// Bricks of a region without a leaf, and the number of the group of each.
std::unordered_map<Coord, std::size_t> emptyBricks(const openvdb::FloatTree& band,
                                                   const Region& region,
                                                   const openvdb::CoordBBox& box) {
  std::unordered_map<Coord, std::size_t> bricks;
  const openvdb::CoordBBox all(box.min() >> kBrickLog2, box.max() >> kBrickLog2);
  for (auto brick = all.begin(); brick; ++brick) {
    const Coord origin = *brick << kBrickLog2;
    if (region.meetsBricks(openvdb::CoordBBox::createCube(origin, kBrickSide)) &&
        band.probeConstNode<Lower>(origin) == nullptr)
      bricks.emplace(*brick, 0);
  }
  return bricks;
}

/// Numbers the groups from 1; returns a brick of each.
std::vector<Coord> groupsOf(std::unordered_map<Coord, std::size_t>& bricks) {
  std::vector<Coord> first;
  std::vector<Coord> open;
  for (const auto& [seed, group] : bricks) {
    if (group != 0) continue;
    first.push_back(seed);
    open = {seed};
    while (!open.empty()) {
      const Coord at = open.back();
      open.pop_back();
      const auto found = bricks.find(at);
      if (found == bricks.end() || found->second != 0) continue;
      found->second = first.size();
      for (int side = 0; side < 6; ++side) {
        Coord next = at;
        next[side / 2] += side % 2 == 0 ? 1 : -1;
        open.push_back(next);
      }
    }
  }
  return first;
}

}  // namespace

void setInnerBricks(openvdb::FloatTree& band, const Region& region, const openvdb::CoordBBox& box,
                    float inside, const AreInside& areInside) {
  std::unordered_map<Coord, std::size_t> bricks = emptyBricks(band, region, box);
  std::vector<Coord> middles = groupsOf(bricks);
  if (middles.empty()) return;
  for (Coord& brick : middles) brick = (brick << kBrickLog2).offsetBy(kBrickSide / 2);
  const std::vector<char> isInside = areInside(middles);
  for (const auto& [brick, group] : bricks)
    if (isInside[group - 1] != 0)
      band.addTile(Lower::LEVEL + 1, brick << kBrickLog2, inside, false);
}

}  // namespace vox
