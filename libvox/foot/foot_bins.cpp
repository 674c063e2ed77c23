// Cells sorted by the bins that they reach.

#include "libvox/foot/foot_bins.h"

#include "libvox/core/parallel.h"

#include <algorithm>
#include <tuple>
#include <utility>

namespace vox {
namespace {

auto orderOf(const BinnedCell& cell) {
  const openvdb::Coord page = cell.bin >> (kPageLog2 - kBinLog2);
  return std::make_tuple(page.x(), page.y(), page.z(), cell.bin.x(), cell.bin.y(), cell.bin.z(),
                         cell.owner, cell.kind, cell.cell);
}

}  // namespace

bool CellStore::isFar(const Box& part, double reach) const {
  if (!region.hasPages()) return false;
  const double margin = 2 * reach + 1;  // around a boundary the tube is wider
  const Vec3d low = part.low.array() - margin, high = part.high.array() + margin;
  return isFar({openvdb::Coord::floor(openvdb::Vec3d(low.data())),
                openvdb::Coord::ceil(openvdb::Vec3d(high.data()))});
}

void CellStore::bin(const Prism& prism, std::uint32_t owner, std::ptrdiff_t cell, CellKind kind) {
  const openvdb::CoordBBox bins(prism.box.min() >> kBinLog2, prism.box.max() >> kBinLog2);
  const auto enter = [&](const openvdb::Coord& at) {
    if (!region.meetsPages(openvdb::CoordBBox::createCube(at << kBinLog2, kBinSide))) return;
    binned.push_back({at, owner, static_cast<std::uint32_t>(cell), number, kind});
  };
  if (onlyBins == nullptr) {
    for (auto at = bins.begin(); at; ++at) enter(*at);
    return;
  }
  if (bins.volume() > onlyBins->size()) {
    for (const openvdb::Coord& at : *onlyBins)
      if (bins.isInside(at)) enter(at);
    return;
  }
  for (auto at = bins.begin(); at; ++at)
    if (std::binary_search(onlyBins->begin(), onlyBins->end(), *at)) enter(*at);
}

FootBins::FootBins(std::vector<const CellStore*> stores) : stores_(std::move(stores)) {
  std::size_t count = 0;
  for (const CellStore* store : stores_) count += store->binned.size();
  cells_.reserve(count);
  for (const CellStore* store : stores_)
    cells_.insert(cells_.end(), store->binned.begin(), store->binned.end());
  parallelSort(cells_,
               [](const BinnedCell& a, const BinnedCell& b) { return orderOf(a) < orderOf(b); });
  for (std::size_t i = 0; i < cells_.size(); ++i)
    if (i == 0 || cells_[i].bin != cells_[i - 1].bin) begin_.push_back(i);
  begin_.push_back(cells_.size());
}

}  // namespace vox
