// The voxels that a conversion makes.

#include "libvox/grid/region.h"

#include <algorithm>
#include <cmath>

namespace vox {
namespace {

using openvdb::Coord;
using openvdb::CoordBBox;

/// A voxel whose centre is this far outside a box, in voxels, still counts as inside.
constexpr double kRounding = 1e-6;

/// A coordinate as a voxel; far ones come to the end of the grid.
std::int32_t clamped(double x) {
  return static_cast<std::int32_t>(std::clamp(x, -kMaxIndex, kMaxIndex));
}

/// Bits of the y and z of a leaf between two corners.
std::uint64_t rowsOf(const Coord& low, const Coord& high) {
  const auto bits = [](std::int32_t first, std::int32_t last) {
    return (0xffU >> static_cast<unsigned>(7 - last)) & (0xffU << static_cast<unsigned>(first));
  };
  std::uint64_t rows = 0;
  for (std::int32_t y = low.y(); y <= high.y(); ++y)
    rows |= std::uint64_t{bits(low.z(), high.z()) & 0xffU} << static_cast<unsigned>(8 * y);
  return rows;
}

}  // namespace

bool Region::meets(const Box& part) const {
  if (isAll()) return true;
  if (isEmpty()) return false;
  constexpr double kHalf = 0.5;
  CoordBBox voxels;  // those whose cubes meet the box
  for (int axis = 0; axis < 3; ++axis) {
    voxels.min()[axis] = clamped(std::ceil(part.low[axis] - kHalf));
    voxels.max()[axis] = clamped(std::floor(part.high[axis] + kHalf));
  }
  return (!box_ || box_->hasOverlap(voxels)) && meetsPages(voxels);
}

LeafWords Region::within(const LeafWords& voxels, const Coord& origin) const {
  constexpr std::int32_t kLast = 7;
  CoordBBox leaf(origin, origin.offsetBy(kLast));
  if (!meetsPages(leaf)) return {};
  if (!box_ || box_->isInside(leaf)) return voxels;
  LeafWords kept{};
  if (box_->empty() || !box_->hasOverlap(leaf)) return kept;
  leaf.intersect(*box_);
  const Coord low = leaf.min() - origin;
  const Coord high = leaf.max() - origin;
  const std::uint64_t rows = rowsOf(low, high);
  for (std::int32_t x = low.x(); x <= high.x(); ++x) {
    const auto word = static_cast<std::size_t>(x);
    kept[word] = voxels[word] & rows;
  }
  return kept;
}

Region Region::operator&(const Region& other) const {
  Region both = pages_ ? *this : other;
  if (box_ && other.box_)
    both.box_ = CoordBBox(Coord::maxComponent(box_->min(), other.box_->min()),
                          Coord::minComponent(box_->max(), other.box_->max()));
  else
    both.box_ = box_ ? box_ : other.box_;
  return both;
}

Region Region::grown(int voxels) const {
  Region more = *this;
  if (isEmpty()) return more;
  if (box_) more.box_ = CoordBBox(box_->min().offsetBy(-voxels), box_->max().offsetBy(voxels));
  if (pages_) more.margin_ += voxels;
  return more;
}

Region regionOf(const Box& box, const GridTransform& transform) {
  Box inGrid;
  inGrid.add(transform.toIndex(box.low));
  inGrid.add(transform.toIndex(box.high));
  CoordBBox voxels;
  for (int axis = 0; axis < 3; ++axis) {
    voxels.min()[axis] = clamped(std::ceil(inGrid.low[axis] - kRounding));
    voxels.max()[axis] = clamped(std::floor(inGrid.high[axis] + kRounding));
  }
  return Region(voxels);
}

}  // namespace vox
