// The engine alone, from a prepared mesh to a finished grid in memory, beside its parts:
//   evaluation  the same vertices, their coordinates only added up
//   marking     these marked in a brick and packed into bits, which go nowhere
//   engine      all of it
//   nodes       the finished grid's nodes once more, copied by OpenVDB: what the grid costs at
//   least normals     grid `normal` of the finished grid
// Manual times leave out how long it takes to free a grid again.

#include "apps/bench/engine_bench.h"

#include "libvox/core/error.h"
#include "libvox/core/memory.h"
#include "libvox/core/parallel.h"
#include "libvox/core/progress.h"
#include "libvox/grid/mark_brick.h"
#include "libvox/grid/surface_grid.h"
#include "libvox/grid/transform.h"
#include "libvox/grid/voxel_means.h"
#include "libvox/io/read_mesh.h"
#include "libvox/mesh/patch_parts.h"
#include "libvox/pipeline/normals.h"
#include "libvox/pipeline/refine.h"
#include "libvox/pipeline/surface.h"
#include "libvox/subdivide/local_surface.h"
#include "libvox/volume/normal_grid.h"
#include "libvox/voxelize/tile.h"
#include "libvox/voxelize/voxel_box.h"

#include <benchmark/benchmark.h>
#include <openvdb/openvdb.h>
#include <tbb/enumerable_thread_specific.h>

#include <atomic>
#include <chrono>
#include <memory>
#include <numeric>
#include <optional>
#include <string>
#include <utility>

namespace vox::bench {
namespace {

using Clock = std::chrono::steady_clock;

/// A mesh as the engine gets it, at so many voxels along its longest side.
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
      SurfaceGrid grid;
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

/// Keeps patches, and leaves the rest.
class PatchCollector : public SurfaceSink {
 public:
  std::vector<std::pair<Patch, int>> patches;
  void points(std::span<const Vec3d>, int) override {}
  void curve(const CurvePoints&, int, int) override {}
  void patch(const Patch& patch, int k, int) override { patches.emplace_back(patch, k); }
};

/// What the engine works on, and what it makes of it.
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
  SurfaceGrid grid;
  SurfaceReport report;
  Progress unwatched;
  markSurface(work.base, {}, MemoryBudget(0), unwatched, grid, report);
  work.mask->setTree(grid.takeTree());
  return work;
}

/// Calls tile(patch, k) for all parts of a patch that are small enough.
template <class Tile>
void forTiles(const Patch& patch, int k, Tile&& tile) {
  constexpr int kTile = 5;
  const VoxelBox box(patch, kTileError);
  if (k <= kTile && MarkBrick::fits(box.low, box.high)) return tile(patch, k, box);
  for (const auto& row : childrenOf(patch))
    for (const Patch& child : row) forTiles(child, k - 1, tile);
}

/// Times one call of `once` an iteration; its result is freed outside.
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
    forEach(work.patches.size(), 1, [&](std::size_t i) {
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
    forEach(work.patches.size(), 1, [&](std::size_t i) {
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

void normals(benchmark::State& state, const Work& work) {
  Progress unwatched;
  timeEach(state, [&] {
    VoxelMeans means(work.mask->tree());
    addNormals(work.base, {}, unwatched, means);
    means.fillGaps();
    return normalGrid(*work.mask, means);
  });
  setRate(state, "voxels/s", work.mask->activeVoxelCount());
}

/// @param parts  also of the engine's parts
void registerOne(const std::string& name, const PolygonMesh& mesh, int dim, bool parts) {
  // Made when the first of its benchmarks runs.
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
  addPart("normals", normals);
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
