// The sides of pages without leaves.

#include "libvox/pipeline/page_signs.h"

#include "libvox/grid/openvdb.h"
#include "libvox/grid/pages.h"

#include <cstddef>
#include <unordered_map>

namespace vox {
namespace {

using openvdb::Coord;
using PageNode = openvdb::FloatTree::RootNodeType::ChildNodeType::ChildNodeType;
static_assert(PageNode::DIM == kPageSide);

/// Pages of a region without a leaf, and the number of the group of each.
std::unordered_map<Coord, std::size_t> emptyPages(const openvdb::FloatTree& band,
                                                  const Region& region,
                                                  const openvdb::CoordBBox& box) {
  std::unordered_map<Coord, std::size_t> pages;
  const openvdb::CoordBBox all(box.min() >> kPageLog2, box.max() >> kPageLog2);
  for (auto page = all.begin(); page; ++page) {
    const Coord origin = *page << kPageLog2;
    if (region.meetsPages(openvdb::CoordBBox::createCube(origin, kPageSide)) &&
        band.probeConstNode<PageNode>(origin) == nullptr)
      pages.emplace(*page, 0);
  }
  return pages;
}

/// Numbers the groups from 1; returns a page of each.
std::vector<Coord> groupsOf(std::unordered_map<Coord, std::size_t>& pages) {
  std::vector<Coord> first;
  std::vector<Coord> open;
  for (const auto& [seed, group] : pages) {
    if (group != 0) continue;
    first.push_back(seed);
    open = {seed};
    while (!open.empty()) {
      const Coord at = open.back();
      open.pop_back();
      const auto found = pages.find(at);
      if (found == pages.end() || found->second != 0) continue;
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

void setInnerPages(openvdb::FloatTree& band, const Region& region, const openvdb::CoordBBox& box,
                   float inside, const AreInside& areInside) {
  std::unordered_map<Coord, std::size_t> pages = emptyPages(band, region, box);
  std::vector<Coord> middles = groupsOf(pages);
  if (middles.empty()) return;
  for (Coord& page : middles) page = (page << kPageLog2).offsetBy(kPageSide / 2);
  const std::vector<char> isInside = areInside(middles);
  for (const auto& [page, group] : pages)
    if (isInside[group - 1] != 0)
      band.addTile(PageNode::LEVEL + 1, page << kPageLog2, inside, false);
}

}  // namespace vox
