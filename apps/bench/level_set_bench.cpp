// Two ways to level sets, both by OpenVDB's meshToVolume: from polygons refined to a tolerance, as
// for the grid `surface`; and from the polygons of the level whose faces fit into a voxel. Timed
// from mesh to grid, with subdivision. "rms" and "max" are errors of the distances in the band, in
// voxels, compared with polygons that are two levels finer than a voxel.

#include "apps/bench/inputs.h"
#include "libvox/core/memory.h"
#include "libvox/core/progress.h"
#include "libvox/grid/openvdb.h"
#include "libvox/grid/transform.h"
#include "libvox/pipeline/limit_polygons.h"
#include "libvox/subdivide/doo_sabin.h"
#include "libvox/subdivide/stop.h"
#include "libvox/volume/level_set.h"

#include <benchmark/benchmark.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace {

using namespace vox;

constexpr double kBand = 3;

SubdivisionLevel baseOf(const std::string& name, int dim) {
  PolygonMesh mesh = bench::makeInput(name);
  const double scale = dim / usedBox(mesh).longestSide();
  for (Vec3d& p : mesh.points) p *= scale;
  return baseLevel(std::move(mesh));
}

double largestFace(const PolygonMesh& mesh) {
  double largest = 0;
  std::vector<Vec3d> points;
  for (Index f = 0; f < mesh.faceCount(); ++f) {
    points.clear();
    for (const Index v : mesh.face(f)) points.push_back(mesh.points[v]);
    largest = std::max(largest, diameter(points));
  }
  return largest;
}

/// Polygons of the first level whose faces fit into a voxel, or of a level further. Its few faces
/// with more than 4 corners fit into a voxel and become fans.
PolygonMesh voxelSized(SubdivisionLevel level, int further = 0) {
  while (largestFace(level.mesh) > 1) level = subdivide(std::move(level), 1);
  level = subdivide(std::move(level), further);
  PolygonMesh cut;
  cut.points = level.mesh.points;
  for (Index f = 0; f < level.mesh.faceCount(); ++f) {
    const auto face = level.mesh.face(f);
    if (face.size() <= 4)
      cut.addFace(face);
    else
      for (std::size_t i = 1; i + 1 < face.size(); ++i)
        cut.addFace(std::array{face[0], face[i], face[i + 1]});
  }
  return cut;
}

PolygonMesh toTolerance(const SubdivisionLevel& base) {
  constexpr double kTolerance = 0.05;
  const MemoryBudget budget(0);
  const Progress progress;
  return limitPolygons(base, kTolerance, budget, progress);
}

openvdb::FloatGrid::Ptr distances(const PolygonMesh& polygons) {
  return distanceGrid(polygons, openvdb::math::Transform(), kBand, DistanceTo::kSolid,
                      [] { return false; });
}

void countErrors(benchmark::State& state, const openvdb::FloatGrid& grid,
                 const openvdb::FloatGrid& truth) {
  double sum = 0;
  double largest = 0;
  double count = 0;
  for (auto value = grid.cbeginValueOn(); value; ++value) {
    if (!truth.tree().isValueOn(value.getCoord())) continue;
    const double error = std::abs(double{*value} - truth.tree().getValue(value.getCoord()));
    sum += error * error;
    largest = std::max(largest, error);
    ++count;
  }
  state.counters["rms"] = std::sqrt(sum / count);
  state.counters["max"] = largest;
}

void levelSet(benchmark::State& state, const std::string& name, bool voxelLevel) {
  const SubdivisionLevel base = baseOf(name, static_cast<int>(state.range(0)));
  openvdb::FloatGrid::Ptr grid;
  double polygons = 0;
  for (auto _ : state) {
    const PolygonMesh mesh = voxelLevel ? voxelSized(base) : toTolerance(base);
    grid = distances(mesh);
    polygons = mesh.faceCount();
  }
  state.counters["polygons"] = polygons;
  constexpr int kFurther = 2;
  countErrors(state, *grid, *distances(voxelSized(base, kFurther)));
}

void dims(benchmark::internal::Benchmark* benchmark) {
  benchmark->Arg(100)->Arg(200)->ArgName("dim")->Unit(benchmark::kMillisecond)->UseRealTime();
}
BENCHMARK_CAPTURE(levelSet, torus_tolerance, "torus", false)->Apply(dims);
BENCHMARK_CAPTURE(levelSet, torus_voxel_level, "torus", true)->Apply(dims);
BENCHMARK_CAPTURE(levelSet, cube_tolerance, "cube", false)->Apply(dims);
BENCHMARK_CAPTURE(levelSet, cube_voxel_level, "cube", true)->Apply(dims);

}  // namespace

BENCHMARK_MAIN();
