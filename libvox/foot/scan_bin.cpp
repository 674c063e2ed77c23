// Least keys of the voxels of a bin, cell by cell.

#include "libvox/foot/scan_bin.h"

#include <algorithm>
#include <cmath>

namespace vox {
namespace {

const openvdb::CoordBBox& boxOf(const FootBins& bins, const BinnedCell& cell) {
  switch (cell.kind) {
    case CellKind::kNewton:
      return bins.newton(cell).prism.box;
    case CellKind::kPolynomial:
      return bins.polynomial(cell).prism.box;
    case CellKind::kHeight:
      return bins.height(cell).prism.box;
    default:
      return bins.triangle(cell).prism.box;
  }
}

}  // namespace

bool WantedFeet::meet(const openvdb::CoordBBox& box, const openvdb::Coord& binOrigin) const {
  std::array<unsigned, 3> first, end;  // of the leaves along each axis
  for (int axis = 0; axis < 3; ++axis) {
    const auto k = static_cast<std::size_t>(axis);
    const int low = std::max(0, box.min()[axis] - binOrigin[axis]);
    const int high = std::min(kBinSide - 1, box.max()[axis] - binOrigin[axis]);
    if (low > high) return false;
    first[k] = static_cast<unsigned>(low) >> 3;
    end[k] = (static_cast<unsigned>(high) >> 3) + 1;
  }
  // Leaf x, y, z is bit 16 x + 4 y + z.
  const auto bits = [](unsigned from, unsigned to) {
    const auto below = [](unsigned n) {
      return n < 64 ? (std::uint64_t{1} << n) - 1 : ~std::uint64_t{0};
    };
    return below(to) & ~below(from);
  };
  const std::uint64_t alongX = bits(16 * first[0], 16 * end[0]);
  const std::uint64_t alongY = bits(4 * first[1], 4 * end[1]) * 0x0001000100010001;
  const std::uint64_t alongZ = bits(first[2], end[2]) * 0x1111111111111111;
  return (leaves & alongX & alongY & alongZ) != 0;
}

void scanCells(const FootBins& bins, std::span<const BinnedCell> cells, bool unsignedDistance,
               const WantedFeet* wanted, Feet& feet, FootBrick& brick) {
  const auto keep = [&](const Feet& found) {
    for (std::size_t i = 0; i < found.count; ++i) {
      const unsigned leaf = found.leaf(i), voxel = found.voxelOfLeaf(i);
      const float t = found.t[i];
      const std::uint32_t key = keyOf(unsignedDistance ? std::abs(t) : t);
      if (wanted != nullptr && key < wanted->least[leaf][voxel]) continue;
      std::uint32_t& least = brick.leaf(leaf)[voxel];
      least = std::min(least, key);
    }
  };
  const BinMask* const voxels = wanted == nullptr ? nullptr : &wanted->voxels;
  for (const BinnedCell& cell : cells) {
    const openvdb::Coord origin = cell.bin << kBinLog2;
    if (wanted != nullptr && !wanted->meet(boxOf(bins, cell), origin)) continue;
    switch (cell.kind) {
      case CellKind::kNewton:
        scanFeet(bins.newton(cell), origin, voxels, feet, keep);
        break;
      case CellKind::kPolynomial:
        scanPolynomials(bins.polynomial(cell), origin, unsignedDistance,
                        wanted == nullptr ? nullptr : &wanted->least, brick);
        break;
      case CellKind::kHeight:
        scanFeet(bins.height(cell), origin, voxels, feet, keep);
        break;
      case CellKind::kTriangle:
      case CellKind::kRibbon:
        scanFeet(bins.triangle(cell), origin, voxels, feet, keep);
        break;
    }
  }
}

}  // namespace vox
