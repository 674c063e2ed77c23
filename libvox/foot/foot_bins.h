#pragma once

#include "libvox/foot/cell.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace vox {

/// The cells of all threads, sorted by bins. Bins come in the order of pages (128^3 voxels, lower
/// nodes of a tree), and the cells of a bin in an order that does not depend on threads.
class FootBins {
 public:
  /// @param stores  number i has the number i; they must stay valid
  explicit FootBins(std::vector<const CellStore*> stores);

  std::size_t count() const { return begin_.size() - 1; }
  /// Lowest voxel of a bin.
  openvdb::Coord originOf(std::size_t bin) const { return cells_[begin_[bin]].bin << kBinLog2; }
  std::span<const BinnedCell> cellsOf(std::size_t bin) const {
    return std::span(cells_).subspan(begin_[bin], begin_[bin + 1] - begin_[bin]);
  }
  /// A number for each cell of each bin.
  std::int32_t indexOf(const BinnedCell& cell) const {
    return static_cast<std::int32_t>(&cell - cells_.data());
  }
  const BinnedCell& cell(std::int32_t index) const {
    return cells_[static_cast<std::size_t>(index)];
  }
  const NewtonCell& newton(const BinnedCell& cell) const {
    return stores_[cell.store]->newton[cell.cell];
  }
  const PolynomialCell& polynomial(const BinnedCell& cell) const {
    return stores_[cell.store]->polynomial[cell.cell];
  }
  const HeightCell& height(const BinnedCell& cell) const {
    return stores_[cell.store]->heights[cell.cell];
  }
  const TriangleCell& triangle(const BinnedCell& cell) const {
    return stores_[cell.store]->triangles[cell.cell];
  }

 private:
  std::vector<const CellStore*> stores_;
  std::vector<BinnedCell> cells_;
  std::vector<std::size_t> begin_;  // of each bin, and the end
};

}  // namespace vox
