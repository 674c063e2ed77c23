// A preview picture with one ray per pixel: rays alone (flat), with congradient normals, and with
// ambient occlusion.

#include "apps/bench/render_bench.h"

#include "apps/bench/inputs.h"
#include "libvox/pipeline/convert.h"
#include "libvox/render/render.h"
#include "libvox/render/visible.h"

#include <benchmark/benchmark.h>

#include <map>
#include <string>

namespace vox::bench {
namespace {

constexpr int kSide = 1024;

/// The voxels of a generated mesh; made at the first call.
const VisibleGrids& visibleOf(const Input& input) {
  static std::map<std::string, VisibleGrids> known;
  const auto [entry, isNew] = known.try_emplace(std::string(input.name));
  if (isNew) {
    Scene scene;
    scene.objects.push_back({std::string(input.name), input.make()});
    ConvertOptions options;
    options.dim = kSide;
    options.grids = std::vector{GridKind::kMask};
    entry->second = visibleGrids(convert(scene, options).grids, {});
  }
  return entry->second;
}

void picture(benchmark::State& state, const Input& input, Shading shading, int occlusionRays) {
  const VisibleGrids& visible = visibleOf(input);
  RenderOptions options;
  options.width = kSide;
  options.height = kSide;
  options.samples = 1;
  options.shading = {shading, occlusionRays};
  options.threads = static_cast<int>(state.range(0));
  for (auto _ : state) benchmark::DoNotOptimize(render(visible, options).pixels.data());
  state.counters["pixels/s"] =
      benchmark::Counter(double{kSide} * kSide, benchmark::Counter::kIsIterationInvariantRate);
}

}  // namespace

void registerRender() {
  for (const Input& input : inputs()) {
    if (input.name != "torus" && input.name != "cube") continue;
    const auto add = [&](const char* what, Shading shading, int occlusionRays) {
      const std::string name = "render/" + std::string(input.name) + "/" + what;
      benchmark::RegisterBenchmark(name.c_str(), picture, input, shading, occlusionRays)
          ->ArgName("threads")
          ->Arg(1)
          ->Arg(2)
          ->Unit(benchmark::kMillisecond)
          ->UseRealTime();
    };
    add("rays", Shading::kFlat, 0);
    add("congradient", Shading::kCongradient, 0);
    add("occlusion", Shading::kCongradient, 4);
  }
}

}  // namespace vox::bench
