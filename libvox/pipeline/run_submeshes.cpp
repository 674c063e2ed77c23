// Submeshes as tasks.

#include "libvox/pipeline/run_submeshes.h"

#include "libvox/core/parallel.h"
#include "libvox/mesh/area.h"
#include "libvox/pipeline/work.h"

#include <algorithm>
#include <numeric>

namespace vox {
namespace {

/// Share of each submesh in the work. The shares add up to 1.
std::vector<double> sharesOf(const Submeshes& submeshes) {
  const PolygonMesh& mesh = submeshes.base.mesh;
  std::vector<double> shares(submeshes.partition.size(), 0.0);
  constexpr std::size_t kSubmeshesPerTask = 16;
  parallelForEach(submeshes.partition.size(), kSubmeshesPerTask, [&](Index s) {
    for (const Index f : submeshes.partition.submesh(s))
      shares[s] += workOfSurface(areaOf(mesh, f), mesh.faceSize(f));
  });
  const double all = std::accumulate(shares.begin(), shares.end(), 0.0);
  for (double& share : shares) share /= all;
  return shares;
}

/// @param part  of the submesh in the current stage of the progress
void finish(const SubmeshTask& task, bool split, Progress& progress, double part) {
  double vertices = task.walked;
  std::int64_t tiles = 0;
  std::vector<std::int64_t> firstTiles;  // of the large parts, among all tiles
  for (const LargePart& large : task.later) {
    vertices += large.vertices;
    firstTiles.push_back(tiles);
    tiles += large.tiles;
  }
  progress.done(tiles == 0 ? part : part * task.walked / vertices);
  const auto makeTile = [&](std::int64_t tile) {
    progress.check();
    const auto next = std::upper_bound(firstTiles.begin(), firstTiles.end(), tile);
    const LargePart& large = task.later[static_cast<std::size_t>(next - firstTiles.begin() - 1)];
    large.emit(tile - *(next - 1));
    progress.done(part * large.vertices / vertices / static_cast<double>(large.tiles));
  };
  if (split) return parallelForEach(tiles, 1, makeTile);
  for (std::int64_t tile = 0; tile < tiles; ++tile) makeTile(tile);
}

}  // namespace

Submeshes cutIntoSubmeshes(const SubdivisionLevel& base, const SurfaceOptions& options,
                           std::span<const std::uint8_t> leftOut) {
  return {base, coverGreedily(base.mesh, base.adjacency, options.submeshFaces, leftOut),
          options.localize != Localize::kBefore};
}

void skipFarFrom(const Region& region, double margin, Submeshes& submeshes) {
  if (region.isAll()) return;
  const PolygonMesh& mesh = submeshes.base.mesh;
  std::vector<Box> around(mesh.pointCount());  // of each point: the faces around it
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    const Box box = boxOf(mesh, std::span(&f, 1));
    for (const Index v : mesh.face(f)) around[v].add(box);
  }
  submeshes.skipped.resize(submeshes.partition.size());
  for (Index s = 0; s < submeshes.partition.size(); ++s) {
    Box hull;
    for (const Index f : submeshes.partition.submesh(s))
      for (const Index v : mesh.face(f)) hull.add(around[v]);
    hull.low.array() -= margin;
    hull.high.array() += margin;
    submeshes.skipped[s] = !region.meets(hull);
  }
}

void runSubmeshes(const Submeshes& submeshes, Progress& progress, double part,
                  const std::function<void(SubmeshTask&)>& walk) {
  const std::vector<double> shares =
      progress.watched() ? sharesOf(submeshes) : std::vector<double>(submeshes.partition.size());
  parallelForEach(submeshes.partition.size(), 1, [&](Index s) {
    progress.check();
    if (!submeshes.skipped.empty() && submeshes.skipped[s]) return progress.done(part * shares[s]);
    // Isolated: while a thread waits for others, it must not start another submesh.
    tbb::this_task_arena::isolate([&] {
      SubmeshTask task{s, submeshes.partition.submesh(s), progress};
      walk(task);
      finish(task, submeshes.split, progress, part * shares[s]);
    });
  });
}

}  // namespace vox
