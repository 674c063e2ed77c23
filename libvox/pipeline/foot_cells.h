#pragma once

#include "libvox/foot/cell_maker.h"
#include "libvox/foot/foot_bins.h"
#include "libvox/pipeline/prepared_surface.h"

#include <tbb/enumerable_thread_specific.h>

#include <atomic>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <utility>
#include <vector>

namespace vox {

class MemoryBudget;
class Progress;

/// Wraps a sink of one thread, so that only some pieces, or parts of them, reach it.
using PieceFilter = std::function<std::unique_ptr<LimitSink>(LimitSink& cells)>;

/// The cells of some surfaces (foot/cell.h).
class FootCells {
 public:
  /// @param budget  for the cells and their bins
  FootCells(const CellOptions& options, const MemoryBudget& budget)
      : options_(options), budget_(budget) {}
  /// @param onlyBins  bins of interest; empty: all
  FootCells(const CellOptions& options, std::vector<openvdb::Coord> onlyBins,
            const MemoryBudget& budget)
      : options_(options), budget_(budget), onlyBins_(std::move(onlyBins)) {}
  /// @param region  bins that its pages do not meet are of no interest
  FootCells(const CellOptions& options, const Region& region, const MemoryBudget& budget)
      : options_(options), budget_(budget), region_(region) {}
  FootCells(const FootCells&) = delete;
  FootCells& operator=(const FootCells&) = delete;

  /// Adds the limit surface of some faces of a surface. The owners of the cells are the numbers of
  /// the corners, after those of earlier surfaces.
  /// @param faces   ascending; empty: all
  /// @param filter  may be empty
  /// @param part    the share of this in the current stage of `progress`
  /// @throws LimitError  coordinates are out of range, there are too many corners, or not enough
  ///   memory
  /// @throws Cancelled
  void addLimitSurface(const PreparedSurface& surface, const std::vector<Index>& faces,
                       const PieceFilter& filter, Progress& progress, double part);
  /// Adds the triangles of a mesh. The owners of the cells are the numbers of the triangles, after
  /// those of earlier surfaces.
  void addTriangles(const PolygonMesh& triangles, Progress& progress);

  /// The cells sorted by bins. Valid as long as this object is not changed.
  FootBins bins() const;

 private:
  CellStore& newStore();
  void takeOwners(std::uint64_t count);
  void account(std::uint64_t before, const CellStore& store);

  CellOptions options_;
  const MemoryBudget& budget_;
  std::atomic<std::uint64_t> bytes_{0};
  std::vector<openvdb::Coord> onlyBins_;
  Region region_ = {};
  std::uint32_t firstOwner_ = 0;
  std::deque<CellStore> stores_;
  std::mutex mutex_;  // guards stores_ while cells are made
  tbb::enumerable_thread_specific<CellStore*> storeOfThread_{[this] { return &newStore(); }};
};

}  // namespace vox
