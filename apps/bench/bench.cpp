// In-process timings: the stages on a generated torus grid, with CGAL's Doo-Sabin in the same run;
// the engine; files; pictures; and whole conversions of every generated mesh. `vox_bench [MESH...]`
// runs the engine on mesh files, too; --benchmark_format=json prints JSON; see --help for more.

#include "apps/bench/engine_bench.h"
#include "apps/bench/file_bench.h"
#include "apps/bench/inputs.h"
#include "apps/bench/render_bench.h"
#include "libvox/core/error.h"
#include "libvox/pipeline/convert.h"
#include "libvox/subdivide/doo_sabin.h"

#include <benchmark/benchmark.h>
#include <tbb/global_control.h>

#include <string>
#include <vector>

#ifdef VOX_HAVE_CGAL
#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/subdivision_method_3.h>
#endif

namespace {

using namespace vox;

PolygonMesh torus() {
  return bench::makeInput("torus");
}

constexpr int kLevels = 5;

void countVertices(benchmark::State& state, std::size_t vertices) {
  state.counters["vertices/s"] = benchmark::Counter(static_cast<double>(vertices),
                                                    benchmark::Counter::kIsIterationInvariantRate);
}

void dooSabin(benchmark::State& state) {
  const tbb::global_control most(tbb::global_control::max_allowed_parallelism,
                                 static_cast<std::size_t>(state.range(0)));
  const SubdivisionLevel base = baseLevel(torus());
  std::size_t vertices = 0;
  for (auto _ : state) vertices = subdivide(base, kLevels).mesh.points.size();
  countVertices(state, vertices);
}
BENCHMARK(dooSabin)
    ->Arg(1)
    ->Arg(2)
    ->ArgName("threads")
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

#ifdef VOX_HAVE_CGAL
void cgalDooSabin(benchmark::State& state) {
  using Mesh = CGAL::Surface_mesh<CGAL::Simple_cartesian<double>::Point_3>;
  const PolygonMesh base = torus();
  Mesh oracle;
  for (const Vec3d& p : base.points) oracle.add_vertex({p.x(), p.y(), p.z()});
  for (Index f = 0; f < base.faceCount(); ++f) {
    std::vector<Mesh::Vertex_index> face;
    for (const Index v : base.face(f)) face.emplace_back(v);
    oracle.add_face(face);
  }
  std::size_t vertices = 0;
  for (auto _ : state) {
    Mesh mesh = oracle;
    CGAL::Subdivision_method_3::DooSabin_subdivision(
        mesh, CGAL::parameters::number_of_iterations(kLevels));
    vertices = mesh.number_of_vertices();
  }
  countVertices(state, vertices);
}
BENCHMARK(cgalDooSabin)->Unit(benchmark::kMillisecond)->UseRealTime();
#endif

/// From mesh to grid, in memory. Compare voxels/s with that of the torus.
void wholeConversion(benchmark::State& state, const bench::Input& input) {
  Scene scene;
  scene.objects.push_back({std::string(input.name), input.make()});
  ConvertOptions options;
  options.dim = static_cast<int>(state.range(0));
  options.grids = std::vector{GridKind::kMask};
  std::uint64_t voxels = 0;
  try {
    for (auto _ : state) voxels = convert(scene, options).report.activeVoxels;
  } catch (const LimitError& error) {
    state.SkipWithError(error.what());
    return;
  }
  state.counters["voxels/s"] = benchmark::Counter(static_cast<double>(voxels),
                                                  benchmark::Counter::kIsIterationInvariantRate);
}

void registerConversions() {
  for (const bench::Input& input : bench::inputs()) {
    const std::string name = "wholeConversion/" + std::string(input.name);
    auto* conversion = benchmark::RegisterBenchmark(name.c_str(), wholeConversion, input);
    conversion->ArgName("dim")->Unit(benchmark::kMillisecond)->UseRealTime();
    conversion->Arg(256)->Arg(512)->Arg(1024);
  }
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  // Arguments that Google Benchmark does not take are mesh files, unless they look like options.
  std::vector<std::string> meshFiles;
  for (int i = 1; i < argc; ++i) {
    if (argv[i][0] == '-' && benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    meshFiles.emplace_back(argv[i]);
  }
  bench::registerEngine(meshFiles);
  bench::registerFiles();
  bench::registerRender();
  registerConversions();
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
}
