// The engine alone, from a prepared mesh to a finished grid in memory, and its parts:
//   - evaluation: the vertices of the engine; their coordinates are only summed;
//   - marking: the vertices are marked in a brick and packed into bits, which are dropped;
//   - engine: all of it;
//   - nodes: a copy of the nodes of the finished grid by OpenVDB, a lower bound of its cost;
//   - normals: grid `normal` of the finished grid.
// Times do not count the freeing of grids.

#include "apps/bench/engine_bench.h"

#include "libvox/core/error.h"
#include "libvox/core/memory.h"
#include "libvox/core/parallel.h"
#include "libvox/core/progress.h"
#include "libvox/grid/active_voxels.h"
#include "libvox/grid/mark_brick.h"
#include "libvox/grid/openvdb.h"
#include "libvox/grid/transform.h"
#include "libvox/io/read_mesh.h"
#include "libvox/mesh/patch_parts.h"
#include "libvox/pipeline/convert.h"
#include "libvox/pipeline/refine.h"
#include "libvox/pipeline/surface.h"
#include "libvox/subdivide/local_surface.h"
#include "libvox/voxelize/tile.h"
#include "libvox/voxelize/voxel_box.h"

#include <benchmark/benchmark.h>
#include <tbb/enumerable_thread_specific.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace vox::bench {
namespace {

using Clock = std::chrono::steady_clock;

/// The mesh as the engine gets it: prepared, in index space, `dim` voxels along its longest side.
SubdivisionLevel preparedAt(const PolygonMesh& mesh, int dim) {
  Scene scene;
  scene.objects.push_back({"mesh", mesh});
  Progress unwatched;
  SubdivisionLevel base =
      prepare(scene, scene.objects[0], preparationsOf(scene, {})[0], MemoryBudget(0), unwatched)
          .base;
  const GridTransform transform = transformForDim(usedBox(mesh), dim);
  for (Vec3d& point : base.mesh.points) point = transform.toIndex(point);
  return base;
}

void setRate(benchmark::State& state, const char* name, std::uint64_t count) {
  state.counters[name] =
      benchmark::Counter(static_cast<double>(count), benchmark::Counter::kIsIterationInvariantRate);
}

void engine(benchmark::State& state, const PolygonMesh& mesh) {
  const SubdivisionLevel base = preparedAt(mesh, static_cast<int>(state.range(0)));
  const MemoryBudget budget(0);
  Progress unwatched;
  std::uint64_t voxels = 0;
  std::uint64_t vertices = 0;
  onThreads(static_cast<int>(state.range(1)), [&] {
    for (auto _ : state) {
      const auto start = Clock::now();
      ActiveVoxels grid;
      SurfaceReport report;
      markSurface(base, {}, budget, unwatched, grid, report);
      const auto tree = grid.takeTree();
      state.SetIterationTime(std::chrono::duration<double>(Clock::now() - start).count());
      voxels = tree->activeVoxelCount();
      vertices = 0;
      for (const auto count : report.vertices) vertices += count;
    }
    return 0;
  });
  setRate(state, "voxels/s", voxels);
  state.counters["vertices/voxel"] = static_cast<double>(vertices) / static_cast<double>(voxels);
}

/// Keeps patches and ignores points and curves.
class PatchCollector : public SurfaceSink {
 public:
  std::vector<std::pair<Patch, int>> patches;
  void points(std::span<const Vec3d>, int) override {}
  void curve(const CurvePoints&, int, int) override {}
  void patch(const Patch& patch, int k, int) override { patches.emplace_back(patch, k); }
};

/// Input and results of the engine.
struct Work {
  SubdivisionLevel base;
  std::vector<std::pair<Patch, int>> patches;
  openvdb::MaskGrid::Ptr mask;
};

Work workAt(const PolygonMesh& mesh, int dim) {
  Work work{preparedAt(mesh, dim), {}, openvdb::MaskGrid::create()};
  std::vector<Index> faces(work.base.mesh.faceCount());
  std::iota(faces.begin(), faces.end(), Index{0});
  PatchCollector collector;
  LocalSurface(work.base).emit(faces, collector);
  for (auto& patch : collector.patches)
    if (patch.second >= kLeastTileLevels) work.patches.push_back(std::move(patch));
  ActiveVoxels grid;
  SurfaceReport report;
  Progress unwatched;
  markSurface(work.base, {}, MemoryBudget(0), unwatched, grid, report);
  work.mask->setTree(grid.takeTree());
  return work;
}

/// Splits a patch into parts that are small enough for a tile, and calls tile(patch, k) for each.
template <class Tile>
void forTiles(const Patch& patch, int k, Tile&& tile) {
  constexpr int kTile = 5;
  const VoxelBox box(patch, kTileError);
  if (k <= kTile && MarkBrick::fits(box.low, box.high)) return tile(patch, k, box);
  for (const auto& row : childrenOf(patch))
    for (const Patch& child : row) forTiles(child, k - 1, tile);
}

/// Times one call of `once` per iteration. The time to free its result is not counted.
template <class Once>
void timeEach(benchmark::State& state, Once&& once) {
  onThreads(static_cast<int>(state.range(1)), [&] {
    for (auto _ : state) {
      const auto start = Clock::now();
      const auto result = once();
      state.SetIterationTime(std::chrono::duration<double>(Clock::now() - start).count());
      benchmark::DoNotOptimize(result);
    }
    return 0;
  });
}

void evaluation(benchmark::State& state, const Work& work) {
  timeEach(state, [&] {
    std::atomic<std::uint32_t> sum = 0;
    parallelForEach(work.patches.size(), 1, [&](std::size_t i) {
      forTiles(work.patches[i].first, work.patches[i].second,
               [&](const Patch& tile, int k, const VoxelBox&) {
                 sum += sumTile(tileControls(tile), k);
               });
    });
    return sum.load();
  });
  std::uint64_t vertices = 0;
  for (const auto& [patch, k] : work.patches) vertices += std::uint64_t{1} << (2 * k);
  setRate(state, "vertices/s", vertices);
}

void marking(benchmark::State& state, const Work& work) {
  struct Brick {
    MarkBrick marks;
    MarkBrick::Taken taken;
  };
  timeEach(state, [&] {
    tbb::enumerable_thread_specific<Brick> bricks;
    std::atomic<std::size_t> leaves = 0;
    parallelForEach(work.patches.size(), 1, [&](std::size_t i) {
      Brick& brick = bricks.local();
      forTiles(work.patches[i].first, work.patches[i].second,
               [&](const Patch& tile, int k, const VoxelBox& box) {
                 markTile(tileControls(tile), k, brick.marks.marks());
                 brick.marks.take(box.low, box.high, brick.taken);
                 leaves += brick.taken.count;
               });
    });
    return leaves.load();
  });
}

void nodes(benchmark::State& state, const Work& work) {
  timeEach(state, [&] { return work.mask->deepCopy(); });
}

/// The grid `normal` without the voxels, which it is made for.
void normals(benchmark::State& state, const PolygonMesh& mesh) {
  Scene scene;
  scene.objects.push_back({"mesh", mesh});
  ConvertOptions options;
  options.dim = static_cast<int>(state.range(0));
  options.grids = std::vector{GridKind::kNormal};
  options.run.threads = static_cast<int>(state.range(1));
  std::uint64_t voxels = 0;
  for (auto _ : state) {
    const ConvertReport report = convert(scene, options).report;
    state.SetIterationTime(report.gridsSeconds);
    voxels = report.activeVoxels;
  }
  setRate(state, "voxels/s", voxels);
}

/// Registers the benchmarks of one mesh.
/// @param parts  whether to time the parts of the engine, too
void registerOne(const std::string& name, const PolygonMesh& mesh, int dim, bool parts) {
  // Set when the first benchmark of the mesh runs.
  const auto work = std::make_shared<std::optional<Work>>();
  const auto add = [&](const char* what, const auto& run) {
    benchmark::RegisterBenchmark((what + ("/" + name)).c_str(), run)
        ->ArgNames({"dim", "threads"})
        ->Args({dim, 1})
        ->Args({dim, 2})
        ->Unit(benchmark::kMillisecond)
        ->UseManualTime();
  };
  const auto addPart = [&](const char* what, void (*part)(benchmark::State&, const Work&)) {
    add(what, [=](benchmark::State& state) {
      if (!*work) *work = workAt(mesh, dim);
      part(state, **work);
    });
  };
  if (parts) {
    addPart("evaluation", evaluation);
    addPart("marking", marking);
    addPart("nodes", nodes);
  }
  add("engine", [=](benchmark::State& state) { engine(state, mesh); });
  add("normals", [=](benchmark::State& state) { normals(state, mesh); });
}

}  // namespace

void registerEngine(const std::vector<std::string>& meshFiles) {
  for (const Input& input : inputs()) {
    const bool dense = input.name.starts_with("triangles");
    const int dim = input.name == "torus" ? 2048 : dense ? 256 : 1024;
    registerOne(std::string(input.name), input.make(), dim,
                input.name == "torus" || input.name == "cube");
  }
  for (const std::string& file : meshFiles) {
    const PolygonMesh mesh = readMesh(file);
    for (const int dim : {256, 1024}) registerOne(file, mesh, dim, true);
  }
}

}  // namespace vox::bench
