// Submeshes as tasks that make cells.

#include "libvox/pipeline/foot_cells.h"

#include "libvox/core/error.h"
#include "libvox/core/memory.h"
#include "libvox/core/parallel.h"
#include "libvox/core/progress.h"
#include "libvox/foot/height_maker.h"
#include "libvox/foot/triangle_maker.h"
#include "libvox/grid/transform.h"
#include "libvox/pipeline/joined_vertices.h"
#include "libvox/pipeline/run_submeshes.h"
#include "libvox/subdivide/limit_walk.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <optional>
#include <utility>

namespace vox {
namespace {

/// A sink of pieces of one thread.
struct PieceSink {
  const CellOptions& options;
  std::uint32_t firstOwner;
  CellStore& store;
  CellMaker maker;
  std::unique_ptr<LimitSink> filter;

  PieceSink(const CellOptions& cellOptions, std::uint32_t first, CellStore& cells,
            const PieceFilter& makeFilter)
      : options(cellOptions), firstOwner(first), store(cells), maker(options, firstOwner, cells) {
    if (makeFilter) filter = makeFilter(maker);
  }

  LimitSink& get() { return filter ? *filter : maker; }
};

/// Adds what stands for all corners at a vertex.
/// @return whether its corners need no cells of their own
bool addVertex(const JoinedVertices& vertices, std::span<const Index> corners, bool withHeights,
               PieceSink& sink) {
  if (sink.store.isFar(vertices.boxAround(corners), sink.options.reach)) return true;
  if (const auto piece = vertices.pieceAt(corners)) {
    sink.get().piece(*piece);
    return true;
  }
  const CellOptions& options = sink.options;
  if (!withHeights || !options.polynomials) return false;
  const auto height = vertices.heightAt(corners, options.heightTolerance);
  if (height)
    addHeightCell(*height, options.reach, options.newtonStop, sink.firstOwner + corners[0],
                  sink.store);
  return height.has_value();
}

/// Adds the cells of small vertices in place of those of their corners.
/// @param skipped       for each face, whether it is left out
/// @param sinkOfThread  makes the sink of a thread
/// @param account       account(before, store): told how the memory of a store has grown
/// @param part          the share of this in the current stage of `progress`
/// @return for each corner, whether its vertex has been added
template <class SinkOfThread, class Account>
std::vector<std::uint8_t> addVertices(const SubdivisionLevel& base,
                                      const std::vector<std::uint8_t>& skipped, bool withHeights,
                                      const SinkOfThread& sinkOfThread, const Account& account,
                                      Progress& progress, double part) {
  const JoinedVertices vertices(base);
  std::vector<std::uint8_t> added(base.mesh.cornerCount(), 0);
  tbb::enumerable_thread_specific<std::unique_ptr<PieceSink>> sinks(sinkOfThread);
  constexpr std::size_t kCornersPerTask = 4096;
  parallelForRanges(added.size(), kCornersPerTask, [&](std::size_t begin, std::size_t end) {
    progress.check();
    PieceSink& sink = *sinks.local();
    const std::uint64_t before = sink.store.bytes();
    std::vector<Index> corners;
    for (auto c = static_cast<Index>(begin); c < end; ++c) {
      if (skipped[base.adjacency.cornerFace[c]] != 0) continue;
      if (!vertices.setCorners(c, corners)) continue;
      if (!addVertex(vertices, corners, withHeights, sink)) continue;
      for (const Index corner : corners) added[corner] = 1;
    }
    account(before, sink.store);
    progress.done(part * static_cast<double>(end - begin) / static_cast<double>(added.size()));
  });
  return added;
}

/// Leaves out the pieces of some corners.
class OtherPieces : public LimitSink {
 public:
  /// @param leftOut  by corner; empty: none
  OtherPieces(const std::vector<std::uint8_t>& leftOut, LimitSink& next)
      : leftOut_(leftOut), next_(next) {}
  void piece(const LimitPiece& piece) override {
    if (leftOut_.empty() || leftOut_[piece.square.corner] == 0) next_.piece(piece);
  }

 private:
  const std::vector<std::uint8_t>& leftOut_;
  LimitSink& next_;
};

/// For each face, whether all its corners are set, or it is not among some faces.
/// @param corners  empty: none is set
/// @param faces  ascending; empty: all
std::vector<std::uint8_t> facesToSkip(const PolygonMesh& mesh, const std::vector<Index>& faces,
                                      const std::vector<std::uint8_t>& corners) {
  std::vector<std::uint8_t> skip(mesh.faceCount(), faces.empty() ? 0 : 1);
  for (const Index f : faces) skip[f] = 0;
  if (corners.empty()) return skip;
  constexpr std::size_t kFacesPerTask = 4096;
  parallelForEach(mesh.faceCount(), kFacesPerTask, [&](std::size_t f) {
    const auto begin = corners.begin() + mesh.faceOffsets[f];
    if (std::all_of(begin, corners.begin() + mesh.faceOffsets[f + 1],
                    [](std::uint8_t set) { return set != 0; }))
      skip[f] = 1;
  });
  return skip;
}

}  // namespace

CellStore& FootCells::newStore() {
  const std::scoped_lock lock(mutex_);
  CellStore& store = stores_.emplace_back();
  store.number = static_cast<std::uint16_t>(stores_.size() - 1);
  if (!onlyBins_.empty()) store.onlyBins = &onlyBins_;
  store.region = region_;
  return store;
}

void FootCells::takeOwners(std::uint64_t count) {
  if (firstOwner_ + count > std::numeric_limits<std::uint32_t>::max())
    throw LimitError("the meshes together have too many corners for one grid");
  firstOwner_ += static_cast<std::uint32_t>(count);
}

void FootCells::addLimitSurface(const PreparedSurface& surface, const std::vector<Index>& faces,
                                const PieceFilter& filter, Progress& progress, double part) {
  const std::uint32_t firstOwner = firstOwner_;
  takeOwners(surface.base.mesh.cornerCount());
  // On a surface of a few voxels, errors of the shape are far from voxels and add up there.
  constexpr double kPartOfSize = 1e-3;
  CellOptions cellOptions = options_;
  cellOptions.creases = !surface.base.seam.empty();
  const double mostTolerance = kPartOfSize * usedBox(surface.base.mesh).longestSide();
  for (double* tolerance :
       {&cellOptions.tolerance.small, &cellOptions.tolerance.large, &cellOptions.heightTolerance})
    *tolerance = std::min(*tolerance, mostTolerance);
  const SubdivisionLevel& base = surface.base;
  const auto sinkOfThread = [&] {
    return std::make_unique<PieceSink>(cellOptions, firstOwner, *storeOfThread_.local(), filter);
  };
  std::vector<std::uint8_t> joined;  // by corner; empty: none
  std::vector<std::uint8_t> skipped = facesToSkip(base.mesh, faces, joined);
  if (!options_.places) {
    constexpr double kPartOfVertices = 0.5;
    joined = addVertices(
        base, skipped, !filter, sinkOfThread,
        [&](std::uint64_t before, const CellStore& store) { account(before, store); }, progress,
        kPartOfVertices * part);
    part -= kPartOfVertices * part;
    skipped = facesToSkip(base.mesh, faces, joined);
  }
  Submeshes submeshes = cutIntoSubmeshes(base, surface.options, skipped);
  // A band needs all cells, unless it is told otherwise: sides of voxels follow from those of
  // others.
  skipFarFrom(options_.places ? surface.region : region_, double{options_.reach} + 1, submeshes);
  if (submeshes.partition.size() == 0) return progress.done(part);
  struct Walk {
    std::unique_ptr<PieceSink> cells;
    OtherPieces others;
    LimitWalk walk;
  };
  const auto walkOfThread = [&] {
    std::unique_ptr<PieceSink> cells = sinkOfThread();
    LimitSink& sink = cells->get();
    return std::make_unique<Walk>(std::move(cells), OtherPieces(joined, sink),
                                  LimitWalk(base, cellOptions.tolerance));
  };
  runSubmeshes(submeshes, progress, part, walkOfThread,
               [&](const std::unique_ptr<Walk>& walk, const SubmeshTask& task) {
                 CellStore& store = walk->cells->store;
                 const std::uint64_t before = store.bytes();
                 walk->walk.emit(task.faces, walk->others);
                 account(before, store);
               });
}

void FootCells::addTriangles(const PolygonMesh& triangles, Progress& progress) {
  constexpr std::size_t kTrianglesPerTask = 1024;
  const std::uint32_t firstOwner = firstOwner_;
  takeOwners(triangles.faceCount());
  const TriangleMaker maker(triangles, options_.reach);
  parallelForRanges(
      triangles.faceCount(), kTrianglesPerTask, [&](std::size_t begin, std::size_t end) {
        progress.check();
        CellStore& store = *storeOfThread_.local();
        const std::uint64_t before = store.bytes();
        maker.add(static_cast<Index>(begin), static_cast<Index>(end), firstOwner, store);
        account(before, store);
      });
}

void FootCells::account(std::uint64_t before, const CellStore& store) {
  bytes_ += store.bytes() - before;
  budget_.require(2 * bytes_, "the cells of the surface",
                  "use a smaller --band or larger voxels, or raise --max-memory");
}

FootBins FootCells::bins() const {
  std::vector<const CellStore*> stores;
  for (const CellStore& store : stores_) stores.push_back(&store);
  return FootBins(std::move(stores));
}

}  // namespace vox
