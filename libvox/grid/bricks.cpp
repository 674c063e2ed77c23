// The order of the lower nodes of an OpenVDB file.

#include "libvox/grid/bricks.h"

#include <algorithm>
#include <tuple>

namespace vox {
namespace {

constexpr int kUpperLog2 = 5;  // bricks along an upper node

auto orderOf(const openvdb::Coord& brick) {
  const openvdb::Coord upper = brick >> kUpperLog2;
  return std::make_tuple(upper.x(), upper.y(), upper.z(), brick.x(), brick.y(), brick.z());
}

}  // namespace

bool isBefore(const openvdb::Coord& brick, const openvdb::Coord& other) {
  return orderOf(brick) < orderOf(other);
}

bool BrickRange::meets(const openvdb::CoordBBox& box) const {
  const openvdb::CoordBBox bricks(box.min() >> kBrickLog2, box.max() >> kBrickLog2);
  constexpr openvdb::Index64 kMostAsked = 1 << 13;
  const openvdb::Coord size = bricks.dim();
  if (std::max({size.x(), size.y(), size.z()}) > kBrickSide || bricks.volume() > kMostAsked)
    return true;
  for (auto brick = bricks.begin(); brick; ++brick)
    if (contains(*brick)) return true;
  return false;
}

}  // namespace vox
