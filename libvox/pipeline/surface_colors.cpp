// Colours of a surface at the places where it was voxelized.

#include "libvox/pipeline/surface_colors.h"

#include "libvox/core/memory.h"
#include "libvox/core/parallel.h"
#include "libvox/core/progress.h"
#include "libvox/grid/voxel.h"
#include "libvox/grid/voxel_means.h"
#include "libvox/localize/partition.h"
#include "libvox/pipeline/refine.h"
#include "libvox/subdivide/colored_surface.h"
#include "libvox/subdivide/doo_sabin.h"
#include "libvox/voxelize/triangulate.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace vox {
namespace {

using Writers = tbb::enumerable_thread_specific<VoxelMeans::Writer>;

/// Approximate number of samples of a task.
constexpr std::int64_t kSamplesPerTask = 4096;

/// Calls body for each of `rows` rows of `columns` samples.
template <class Body>
void forRows(std::int64_t rows, std::int64_t columns, Body&& body) {
  const std::int64_t grain = std::max<std::int64_t>(1, kSamplesPerTask / columns);
  if (rows <= grain) {
    for (std::int64_t row = 0; row < rows; ++row) body(row);
    return;
  }
  parallelForEach(rows, static_cast<std::size_t>(grain), body);
}

class VertexSamples : public ColoredSink {
 public:
  explicit VertexSamples(Writers& writers) : writers_(writers) {}

  void point(const Vec3d& position, const Vec3d& color) override {
    writers_.local().add(voxelOf(position), color);
  }
  void patch(const Patch& position, const Patch& color, std::int64_t rows,
             std::int64_t columns) override {
    forRows(rows, columns, [&](std::int64_t row) {
      const PatchWeights across(row, rows);
      curve(rowOf(position, across), rowOf(color, across), columns);
    });
  }
  void curve(const CurvePoints& p, const CurvePoints& c, std::int64_t count) override {
    VoxelMeans::Writer& writer = writers_.local();
    for (std::int64_t i = 0; i < count; ++i) {
      const PatchWeights weights(i, count);
      writer.add(voxelOf(weights(p[0], p[1], p[2])), weights(c[0], c[1], c[2]));
    }
  }

 private:
  Writers& writers_;
};

void sampleVertices(const SubdivisionLevel& base, std::span<const Vec3d> colors,
                    const MemoryBudget& budget, const Progress& progress, Writers& writers) {
  // At least as many faces as any vertex or face has around it: a submesh there needs them all.
  constexpr Index kLeast = 256;
  const Index largest = largestNeighbourhood(base.mesh);
  const Partition partition = coverGreedily(base.mesh, base.adjacency, std::max(kLeast, largest));
  // As measured: 8 KiB for a face at a vertex, 27 KiB for an edge of a face.
  constexpr std::uint64_t kBytesPerNeighbour = 32 << 10;
  const auto atATime = std::min<std::uint64_t>(
      partition.size(), static_cast<std::uint64_t>(tbb::this_task_arena::max_concurrency()));
  budget.require(kBytesPerNeighbour * largest * atATime,
                 "colours where " + std::to_string(largest) + " faces or edges meet",
                 "divide what meets there, use fewer threads, or raise --max-memory");
  tbb::enumerable_thread_specific<ColoredSurface> surfaces(
      [&] { return ColoredSurface(base, colors); });
  VertexSamples samples(writers);
  parallelForEach(partition.size(), 1, [&](Index s) {
    progress.check();
    // Isolated: while a thread waits for rows, it must not start another submesh.
    tbb::this_task_arena::isolate([&] { surfaces.local().emit(partition.submesh(s), samples); });
  });
}

/// A corner of a triangle.
struct Sample {
  Vec3d position;
  Vec3d color;
};

Sample between(const Sample& a, const Sample& b, std::int64_t i, std::int64_t n) {
  const double t = static_cast<double>(i) / static_cast<double>(n);
  return {a.position + t * (b.position - a.position), a.color + t * (b.color - a.color)};
}

/// Steps of at most half a voxel from a to b.
std::int64_t stepsBetween(const Sample& a, const Sample& b) {
  constexpr double kPerVoxel = 2;
  const double length = (b.position - a.position).cwiseAbs().maxCoeff();
  return std::max<std::int64_t>(1, static_cast<std::int64_t>(std::ceil(kPerVoxel * length)));
}

/// Samples in rows parallel to the shortest side, so that a needle takes few samples.
void sampleTriangle(std::array<Sample, 3> corners, Writers& writers) {
  const auto length = [&](std::size_t i) { return stepsBetween(corners[i], corners[(i + 1) % 3]); };
  while (length(0) > length(1) || length(0) > length(2))
    std::rotate(corners.begin(), corners.begin() + 1, corners.end());
  const auto& [a, b, c] = corners;
  const std::int64_t rows = std::max(length(1), length(2));
  forRows(rows + 1, length(0), [&](std::int64_t row) {
    const Sample left = between(a, c, row, rows);
    const Sample right = between(b, c, row, rows);
    const std::int64_t columns = stepsBetween(left, right);
    VoxelMeans::Writer& writer = writers.local();
    for (std::int64_t column = 0; column <= columns; ++column) {
      const Sample sample = between(left, right, column, columns);
      writer.add(voxelOf(sample.position), sample.color);
    }
  });
}

/// A level with the colours of its points; level 0: with the colours of its corners.
ColoredLevel coloredLevel(const SubdivisionLevel& base, std::span<const Vec3d> colors, int levels,
                          const MemoryBudget& budget, const Progress& progress) {
  ColoredLevel colored{base, {colors.begin(), colors.end()}};
  for (int k = 1; k <= levels; ++k) {
    progress.check();
    const SubdivisionLevel& level = colored.level;
    budget.require(bytesOf(level) + 2 * bytesOfImage(level) + bytesOfNextTopology(level),
                   "level " + std::to_string(k) + " with its colours",
                   "use fewer levels, or raise --max-memory");
    colored = k == 1 ? firstColoredLevel(colored) : nextColoredLevel(std::move(colored));
  }
  return colored;
}

void samplePolygons(const ColoredLevel& colored, bool ofCorners, const Progress& progress,
                    Writers& writers) {
  constexpr std::size_t kFaceGrain = 64;
  const PolygonMesh& mesh = colored.level.mesh;
  parallelForRanges(mesh.faceCount(), kFaceGrain, [&](std::size_t begin, std::size_t end) {
    progress.check();
    std::vector<Vec3d> corners;
    std::vector<std::array<Index, 3>> triangles;
    TriangulationReport report;
    for (Index f = static_cast<Index>(begin); f != end; ++f) {
      corners.clear();
      triangles.clear();
      for (const Index v : mesh.face(f)) corners.push_back(mesh.points[v]);
      triangulate(corners, triangles, report);
      const auto sampleAt = [&](Index i) -> Sample {
        const Index c = mesh.faceOffsets[f] + i;
        return {corners[i], colored.colors[ofCorners ? c : mesh.faceVertices[c]]};
      };
      for (const auto& [i, j, k] : triangles)
        sampleTriangle({sampleAt(i), sampleAt(j), sampleAt(k)}, writers);
    }
  });
}

}  // namespace

void sampleColors(const SubdivisionLevel& base, std::span<const Vec3d> cornerColors,
                  std::optional<int> levels, const MemoryBudget& budget, const Progress& progress,
                  VoxelMeans& means) {
  Writers writers([&] { return VoxelMeans::Writer(means); });
  if (!levels) return sampleVertices(base, cornerColors, budget, progress, writers);
  const ColoredLevel level = coloredLevel(base, cornerColors, *levels, budget, progress);
  samplePolygons(level, *levels == 0, progress, writers);
}

}  // namespace vox
