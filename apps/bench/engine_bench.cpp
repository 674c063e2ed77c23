// The engine alone, from a prepared mesh to a finished grid in memory, beside its evaluation loop:
// the same vertices, their coordinates only added up. Manual times leave out how long it takes to
// free the grid again.

#include "apps/bench/engine_bench.h"

#include "libvox/core/error.h"
#include "libvox/core/parallel.h"
#include "libvox/core/progress.h"
#include "libvox/grid/transform.h"
#include "libvox/io/read_mesh.h"
#include "libvox/pipeline/refine.h"
#include "libvox/pipeline/surface.h"
#include "libvox/subdivide/local_surface.h"
#include "libvox/voxelize/tile.h"

#include <benchmark/benchmark.h>

#include <atomic>
#include <chrono>
#include <string>

namespace vox::bench {
namespace {

using Clock = std::chrono::steady_clock;

/// A mesh as the engine gets it, at so many voxels along its longest side.
SubdivisionLevel preparedAt(const PolygonMesh& mesh, int dim) {
  Scene scene;
  scene.objects.push_back({"mesh", mesh});
  Progress unwatched;
  SubdivisionLevel base = prepare(scene, scene.objects[0], {}, MemoryBudget(0), unwatched).base;
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

std::uint32_t evaluate(const Patch& patch, int k) {
  constexpr int kTile = 5;
  if (k <= kTile) return sumTile(tileControls(patch), k);
  std::uint32_t sum = 0;
  for (const auto& row : childrenOf(patch))
    for (const Patch& child : row) sum += evaluate(child, k - 1);
  return sum;
}

void evaluation(benchmark::State& state, const PolygonMesh& mesh) {
  const SubdivisionLevel base = preparedAt(mesh, static_cast<int>(state.range(0)));
  std::vector<Index> faces(base.mesh.faceCount());
  for (Index f = 0; f < base.mesh.faceCount(); ++f) faces[f] = f;
  PatchCollector collector;
  LocalSurface(base).emit(faces, collector);
  std::uint64_t vertices = 0;
  for (const auto& [patch, k] : collector.patches) vertices += std::uint64_t{1} << (2 * k);
  onThreads(static_cast<int>(state.range(1)), [&] {
    for (auto _ : state) {
      const auto start = Clock::now();
      std::atomic<std::uint32_t> sum = 0;
      forEach(collector.patches.size(), 1, [&](std::size_t i) {
        const auto& [patch, k] = collector.patches[i];
        if (k >= kLeastTileLevels) sum += evaluate(patch, k);
      });
      benchmark::DoNotOptimize(sum.load());
      state.SetIterationTime(std::chrono::duration<double>(Clock::now() - start).count());
    }
    return 0;
  });
  setRate(state, "vertices/s", vertices);
}

void registerOne(const std::string& name, const PolygonMesh& mesh, int dim, bool withEvaluation) {
  for (const int threads : {1, 2}) {
    const auto set = [&](auto* bench) {
      bench->Args({dim, threads})->ArgNames({"dim", "threads"});
      bench->Unit(benchmark::kMillisecond)->UseManualTime();
    };
    if (withEvaluation)
      set(benchmark::RegisterBenchmark(("evaluation/" + name).c_str(), evaluation, mesh));
    set(benchmark::RegisterBenchmark(("engine/" + name).c_str(), engine, mesh));
  }
}

}  // namespace

void registerEngine(const std::vector<std::string>& meshFiles) {
  for (const Input& input : inputs()) {
    const bool dense = input.name.starts_with("triangles");
    const int dim = input.name == "torus" ? 2048 : dense ? 256 : 1024;
    registerOne(std::string(input.name), input.make(), dim, input.name == "torus");
  }
  for (const std::string& file : meshFiles) {
    const PolygonMesh mesh = readMesh(file);
    for (const int dim : {256, 1024}) registerOne(file, mesh, dim, false);
  }
}

}  // namespace vox::bench
