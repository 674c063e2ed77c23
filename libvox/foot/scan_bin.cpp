// Least keys of the voxels of a bin, cell by cell.

#include "libvox/foot/scan_bin.h"

#include <algorithm>
#include <cmath>

namespace vox {

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
    switch (cell.kind) {
      case CellKind::kNewton:
        scanFeet(bins.newton(cell), origin, voxels, feet, keep);
        break;
      case CellKind::kPolynomial:
        scanPolynomials(bins.polynomial(cell), origin, unsignedDistance,
                        wanted == nullptr ? nullptr : &wanted->least, brick);
        break;
      case CellKind::kTriangle:
      case CellKind::kRibbon:
        scanFeet(bins.triangle(cell), origin, voxels, feet, keep);
        break;
    }
  }
}

}  // namespace vox
