// The order of the lower nodes of an OpenVDB file.

#include "libvox/grid/pages.h"

#include <algorithm>
#include <tuple>

namespace vox {
namespace {

constexpr int kUpperLog2 = 5;  // pages along an upper node

auto orderOf(const openvdb::Coord& page) {
  const openvdb::Coord upper = page >> kUpperLog2;
  return std::make_tuple(upper.x(), upper.y(), upper.z(), page.x(), page.y(), page.z());
}

}  // namespace

bool isBefore(const openvdb::Coord& page, const openvdb::Coord& other) {
  return orderOf(page) < orderOf(other);
}

bool PageRange::meets(const openvdb::CoordBBox& box) const {
  const openvdb::CoordBBox pages(box.min() >> kPageLog2, box.max() >> kPageLog2);
  constexpr int kMostAlong = 128;
  constexpr openvdb::Index64 kMostAsked = 1 << 13;
  if (box.empty()) return false;
  const openvdb::Coord size = pages.dim();
  if (std::max({size.x(), size.y(), size.z()}) > kMostAlong || pages.volume() > kMostAsked)
    return true;
  for (auto page = pages.begin(); page; ++page)
    if (contains(*page)) return true;
  return false;
}

}  // namespace vox
