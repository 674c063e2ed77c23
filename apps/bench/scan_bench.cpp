// In-process timings of triangle scan conversion on one thread: spheres of equilateral triangles
// with a given edge, for both separations; and, for comparison, OpenVDB's meshToVolume (unsigned,
// thinnest band) on the same triangles in the same run. `vox_scan_bench --benchmark_format=json`
// prints JSON.

#include "libvox/grid/openvdb.h"
#include "libvox/voxelize/scan.h"

#include <benchmark/benchmark.h>
#include <openvdb/tools/MeshToVolume.h>
#include <tbb/global_control.h>

#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

namespace {

using namespace vox;

struct Surface {
  std::vector<Vec3d> points;
  std::vector<std::array<Index, 3>> triangles;
};

/// Sphere of 8 * 4^levels triangles of about the given edge, in voxels.
Surface sphere(int levels, double edge) {
  Surface surface;
  surface.points = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  surface.triangles = {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4},
                       {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  for (int level = 0; level < levels; ++level) {
    std::map<std::pair<Index, Index>, Index> middles;
    const auto middle = [&](Index a, Index b) {
      const auto [found, isNew] =
          middles.try_emplace(std::minmax(a, b), static_cast<Index>(surface.points.size()));
      if (isNew) surface.points.push_back((surface.points[a] + surface.points[b]).normalized());
      return found->second;
    };
    std::vector<std::array<Index, 3>> finer;
    for (const auto& [a, b, c] : surface.triangles) {
      const Index ab = middle(a, b);
      const Index bc = middle(b, c);
      const Index ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    surface.triangles = finer;
  }
  // The area of the sphere is that of the triangles, sqrt(3) / 4 edge^2 each.
  const double count = static_cast<double>(surface.triangles.size());
  const double radius = edge * std::sqrt(count * std::sqrt(3.0) / 4 / (4 * std::numbers::pi));
  for (Vec3d& p : surface.points) p = radius * p + Vec3d(0.1, 0.2, 0.3);
  return surface;
}

/// Registers edges of 0.7 to 40 voxels. With 0.7 and 1.5, triangles have 1 to 4 voxels
/// (6-separating), as in dense meshes; with 15, about 100.
void edges(benchmark::internal::Benchmark* benchmark) {
  for (const int tenths : {7, 15, 30, 60, 150, 400}) benchmark->Arg(tenths);
  benchmark->ArgName("edge/10")->Unit(benchmark::kMillisecond);
}

Surface surfaceOf(const benchmark::State& state) {
  const double edge = static_cast<double>(state.range(0)) / 10;
  return sphere(edge < 5 ? 7 : 5, edge);
}

void count(benchmark::State& state, const Surface& surface, std::uint64_t voxels) {
  const auto rate = [](double count) {
    return benchmark::Counter(count / 1e6, benchmark::Counter::kIsIterationInvariantRate);
  };
  const auto triangles = static_cast<double>(surface.triangles.size());
  state.counters["Mtriangles/s"] = rate(triangles);
  state.counters["Mvoxels/s"] = rate(static_cast<double>(voxels));
  state.counters["voxels/triangle"] = static_cast<double>(voxels) / triangles;
}

/// The kernel alone: blocks are made and read, not stored. A voxel counts once per triangle.
void scan(benchmark::State& state, Separation separation) {
  const Surface surface = surfaceOf(state);
  std::uint64_t voxels = 0;
  scanTriangles(surface.points, surface.triangles, separation, [&](const VoxelBlock& block) {
    voxels += static_cast<std::uint64_t>(std::popcount(block.voxels));
  });
  for (auto _ : state) {
    std::uint64_t sum = 0;
    scanTriangles(surface.points, surface.triangles, separation,
                  [&](const VoxelBlock& block) { sum += block.voxels; });
    benchmark::DoNotOptimize(sum);
  }
  count(state, surface, voxels);
}
BENCHMARK_CAPTURE(scan, 6, Separation::k6)->Apply(edges);
BENCHMARK_CAPTURE(scan, 26, Separation::k26)->Apply(edges);

/// The kernel, with its voxels put into an OpenVDB mask one by one.
void scanToMask(benchmark::State& state, Separation separation) {
  const Surface surface = surfaceOf(state);
  std::uint64_t voxels = 0;
  for (auto _ : state) {
    openvdb::MaskTree tree;
    openvdb::tree::ValueAccessor<openvdb::MaskTree> accessor(tree);
    scanTriangles(surface.points, surface.triangles, separation, [&](const VoxelBlock& block) {
      forEachVoxel(block, [&](int x, int y, int z) { accessor.setValueOn({x, y, z}); });
    });
    voxels = tree.activeVoxelCount();
  }
  count(state, surface, voxels);
}
BENCHMARK_CAPTURE(scanToMask, 6, Separation::k6)->Apply(edges);
BENCHMARK_CAPTURE(scanToMask, 26, Separation::k26)->Apply(edges);

/// OpenVDB's unsigned distances in the thinnest band that it makes: voxels whose centre is within
/// one voxel of the surface. On one thread, like the others.
void openvdbMeshToVolume(benchmark::State& state) {
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const Surface surface = surfaceOf(state);
  std::vector<openvdb::Vec3s> points;
  std::vector<openvdb::Vec3I> triangles;
  for (const Vec3d& p : surface.points) points.emplace_back(openvdb::Vec3d(p.data()));
  for (const auto& t : surface.triangles) triangles.emplace_back(t[0], t[1], t[2]);
  const openvdb::tools::QuadAndTriangleDataAdapter<openvdb::Vec3s, openvdb::Vec3I> mesh(points,
                                                                                        triangles);
  std::uint64_t voxels = 0;
  for (auto _ : state) {
    const auto grid = openvdb::tools::meshToVolume<openvdb::FloatGrid>(
        mesh, openvdb::math::Transform(), 1.0F, 1.0F, openvdb::tools::UNSIGNED_DISTANCE_FIELD);
    voxels = grid->activeVoxelCount();
  }
  count(state, surface, voxels);
}
BENCHMARK(openvdbMeshToVolume)->Apply(edges);

}  // namespace

BENCHMARK_MAIN();
