// Submeshes as tasks that make cells.

#include "libvox/pipeline/foot_cells.h"

#include "libvox/core/error.h"
#include "libvox/core/memory.h"
#include "libvox/core/parallel.h"
#include "libvox/core/progress.h"
#include "libvox/foot/triangle_maker.h"
#include "libvox/grid/transform.h"
#include "libvox/pipeline/run_submeshes.h"
#include "libvox/pipeline/whole_vertices.h"
#include "libvox/subdivide/limit_walk.h"

#include <algorithm>
#include <limits>
#include <optional>
#include <utility>

namespace vox {
namespace {

/// What one thread needs to make cells of pieces.
struct CellWalk {
  CellStore& store;
  LimitWalk walk;
  CellMaker maker;
  std::unique_ptr<LimitSink> filter, joined;
  std::vector<Index> faces, lastFaces;  // the walk still needs those of the last call

  /// @param whole  may be null
  CellWalk(const SubdivisionLevel& base, const CellOptions& options, std::uint32_t firstOwner,
           CellStore& cells, const PieceFilter& makeFilter, const WholeVertices* whole)
      : store(cells), walk(base, options.tolerance), maker(options, firstOwner, cells) {
    if (makeFilter) filter = makeFilter(maker);
    if (whole != nullptr) joined = std::make_unique<JoinedPieces>(*whole, filtered());
  }

  LimitSink& filtered() { return filter ? *filter : maker; }

  /// @param among  the faces to walk over, ascending; empty: all
  void emit(std::span<const Index> submesh, const std::vector<Index>& among) {
    LimitSink& sink = joined ? *joined : filtered();
    if (among.empty() || among.size() == walk.base().mesh.faceCount())
      return walk.emit(submesh, sink);
    std::swap(faces, lastFaces);
    faces.clear();
    for (const Index f : submesh)
      if (std::binary_search(among.begin(), among.end(), f)) faces.push_back(f);
    if (faces.empty())
      std::swap(faces, lastFaces);
    else
      walk.emit(faces, sink);
  }
};

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
  for (double* tolerance : {&cellOptions.tolerance.small, &cellOptions.tolerance.large})
    *tolerance = std::min(*tolerance, mostTolerance);
  std::optional<WholeVertices> whole;
  if (!options_.places) whole.emplace(surface.base);
  const auto walkOfThread = [&] {
    return std::make_unique<CellWalk>(surface.base, cellOptions, firstOwner,
                                      *storeOfThread_.local(), filter, whole ? &*whole : nullptr);
  };
  Submeshes submeshes = cutIntoSubmeshes(surface.base, surface.options);
  // A band needs all cells, unless it is told otherwise: sides of voxels follow from those of
  // others.
  skipFarFrom(options_.places ? surface.region : region_, double{options_.reach} + 1, submeshes);
  runSubmeshes(submeshes, progress, part, walkOfThread,
               [&](const std::unique_ptr<CellWalk>& walk, const SubmeshTask& task) {
                 const std::uint64_t before = walk->store.bytes();
                 walk->emit(task.faces, faces);
                 account(before, walk->store);
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
