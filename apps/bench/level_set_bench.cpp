// Level sets, and what there is to compare them with:
//   - surface: the grid `surface`, from a prepared mesh to a finished grid;
//   - fine: OpenVDB's meshToVolume of the mesh, refined before to faces of a voxel;
//   - coarse: meshToVolume of the mesh as it is, which has another shape;
//   - copy: a copy of the finished grid by OpenVDB, a floor: it allocates the same leaves;
//   - write: writing the grid to a file.
// "rms" and "max" are differences from the grid `surface` in its band, in voxels. Arguments are
// mesh files to measure, too.

#include "apps/bench/inputs.h"
#include "libvox/grid/openvdb.h"
#include "libvox/io/read_mesh.h"
#include "libvox/pipeline/convert.h"
#include "libvox/pipeline/refine.h"
#include "libvox/subdivide/doo_sabin.h"

#include <benchmark/benchmark.h>
#include <openvdb/tools/MeshToVolume.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <unistd.h>
#include <utility>
#include <vector>

namespace vox::bench {
namespace {

using Clock = std::chrono::steady_clock;

double secondsSince(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

Conversion levelSetOf(const PolygonMesh& mesh, int dim) {
  Scene scene;
  scene.objects.push_back({"mesh", mesh});
  ConvertOptions options;
  options.dim = dim;
  options.grids = std::vector{GridKind::kSurface};
  return convert(scene, options);
}

const openvdb::FloatGrid& gridOf(const Conversion& conversion) {
  return dynamic_cast<const openvdb::FloatGrid&>(*conversion.grids[0]);
}

/// Polygons as meshToVolume takes them: in index space, of 3 or 4 corners.
class Polygons {
 public:
  Polygons(const PolygonMesh& mesh, double voxelSize) {
    points_.reserve(mesh.points.size());
    for (const Vec3d& p : mesh.points)
      points_.emplace_back(openvdb::Vec3d((p / voxelSize).eval().data()));
    for (Index f = 0; f < mesh.faceCount(); ++f) {
      const auto face = mesh.face(f);
      if (face.size() == 4)
        faces_.emplace_back(face[0], face[1], face[2], face[3]);
      else
        for (std::size_t i = 2; i < face.size(); ++i)
          faces_.emplace_back(face[0], face[i - 1], face[i], openvdb::util::INVALID_IDX);
    }
  }

  openvdb::FloatGrid::Ptr toVolume(double voxelSize) const {
    constexpr float kBand = kDefaultBand;
    const openvdb::tools::QuadAndTriangleDataAdapter<openvdb::Vec3s, openvdb::Vec4I> adapter(
        points_, faces_);
    return openvdb::tools::meshToVolume<openvdb::FloatGrid>(
        adapter, *openvdb::math::Transform::createLinearTransform(voxelSize), kBand, kBand);
  }

  std::size_t count() const { return faces_.size(); }

 private:
  std::vector<openvdb::Vec3s> points_;
  std::vector<openvdb::Vec4I> faces_;
};

double largestFace(const PolygonMesh& mesh) {
  double largest = 0;
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    Box box;
    for (const Index v : mesh.face(f)) box.add(mesh.points[v]);
    largest = std::max(largest, box.longestSide());
  }
  return largest;
}

/// The mesh as the conversion prepares it, subdivided until its faces fit into a voxel.
PolygonMesh voxelSized(const PolygonMesh& mesh, double voxelSize) {
  Scene scene;
  scene.objects.push_back({"mesh", mesh});
  SubdivisionLevel level = baseLevel(refine(scene, 0, {}, {}).mesh);
  while (largestFace(level.mesh) > voxelSize) level = subdivide(std::move(level), 1);
  return std::move(level.mesh);
}

/// What all benchmarks of a mesh compare with.
struct Work {
  PolygonMesh mesh;
  int dim;
  std::optional<Conversion> conversion = {};

  const Conversion& truth() {
    if (!conversion) conversion = levelSetOf(mesh, dim);
    return *conversion;
  }
};

/// @param seconds  of all iterations
void count(benchmark::State& state, const openvdb::FloatGrid& grid, double seconds) {
  const auto voxels = static_cast<double>(grid.activeVoxelCount());
  state.counters["band_voxels"] = voxels;
  state.counters["ns/voxel"] = 1e9 * seconds / static_cast<double>(state.iterations()) / voxels;
}

void countErrors(benchmark::State& state, const openvdb::FloatGrid& grid,
                 const openvdb::FloatGrid& truth) {
  double sum = 0;
  double largest = 0;
  double voxels = 0;
  const auto other = grid.getConstAccessor();
  for (auto value = truth.cbeginValueOn(); value; ++value) {
    const double error =
        std::abs(double{*value} - double{other.getValue(value.getCoord())}) / truth.voxelSize()[0];
    sum += error * error;
    largest = std::max(largest, error);
    ++voxels;
  }
  state.counters["rms"] = std::sqrt(sum / voxels);
  state.counters["max"] = largest;
}

void surface(benchmark::State& state, Work& work) {
  double seconds = 0;
  Conversion made;
  for (auto _ : state) {
    made = levelSetOf(work.mesh, work.dim);
    state.SetIterationTime(made.report.gridsSeconds);
    seconds += made.report.gridsSeconds;
  }
  count(state, gridOf(made), seconds);
}

void meshToVolume(benchmark::State& state, Work& work, bool fine) {
  const Conversion& truth = work.truth();
  const double voxelSize = truth.report.voxelSize;
  const Polygons polygons(fine ? voxelSized(work.mesh, voxelSize) : work.mesh, voxelSize);
  double seconds = 0;
  openvdb::FloatGrid::Ptr grid;
  for (auto _ : state) {
    const auto start = Clock::now();
    grid = polygons.toVolume(voxelSize);
    const double time = secondsSince(start);
    state.SetIterationTime(time);
    seconds += time;
  }
  state.counters["polygons"] = static_cast<double>(polygons.count());
  count(state, *grid, seconds);
  countErrors(state, *grid, gridOf(truth));
}

void copy(benchmark::State& state, Work& work) {
  const openvdb::FloatGrid& grid = gridOf(work.truth());
  double seconds = 0;
  for (auto _ : state) {
    const auto start = Clock::now();
    const auto copied = grid.deepCopy();
    const double time = secondsSince(start);
    state.SetIterationTime(time);
    seconds += time;
  }
  count(state, grid, seconds);
}

void write(benchmark::State& state, Work& work) {
  const Conversion& truth = work.truth();
  const auto file = std::filesystem::temp_directory_path() /
                    ("vox_level_set_bench_" + std::to_string(::getpid()) + ".vdb");
  double seconds = 0;
  for (auto _ : state) {
    const auto start = Clock::now();
    writeGrids(file, truth, true);
    const double time = secondsSince(start);
    state.SetIterationTime(time);
    seconds += time;
  }
  std::filesystem::remove(file);
  count(state, gridOf(truth), seconds);
}

void registerMesh(const std::string& name, const PolygonMesh& mesh) {
  for (const int dim : {256, 512}) {
    const auto work = std::make_shared<Work>(Work{mesh, dim});
    const auto add = [&](const char* what, const auto& run) {
      const std::string full = std::string(what) + "/" + name + "/dim:" + std::to_string(dim);
      benchmark::RegisterBenchmark(full.c_str(),
                                   [=](benchmark::State& state) { run(state, *work); })
          ->Unit(benchmark::kMillisecond)
          ->UseManualTime();
    };
    add("surface", surface);
    add("fine", [](auto& state, Work& of) { meshToVolume(state, of, true); });
    add("coarse", [](auto& state, Work& of) { meshToVolume(state, of, false); });
    add("copy", copy);
    add("write", write);
  }
}

}  // namespace
}  // namespace vox::bench

int main(int argc, char** argv) {
  using namespace vox;
  benchmark::Initialize(&argc, argv);
  openvdb::initialize();
  for (const char* name : {"torus", "cube"}) bench::registerMesh(name, bench::makeInput(name));
  for (int i = 1; i < argc; ++i) {
    if (argv[i][0] == '-' && benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
    bench::registerMesh(argv[i], readMesh(argv[i]));
  }
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
}
